"""Running a model: devices as records, a page of pictures, a video."""
