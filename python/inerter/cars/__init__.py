"""Cars in files: read and checked (`read`), as plain data (`parts`), as a MuJoCo model (`mjcf`)."""
