"""Published studies rebuilt: each makes its data, its figures and its tables anew."""
