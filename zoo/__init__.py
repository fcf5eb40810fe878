"""The zoo: devices drawn into the models that public packages bring, and what has to hold there."""
