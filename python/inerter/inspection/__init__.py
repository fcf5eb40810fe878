"""What a record holds and what it could tell, before anything is diagnosed."""
