"""What is looked at if nobody says otherwise."""

SAMPLES = 4096
SEED = 1
