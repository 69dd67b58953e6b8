"""What is asked for, checked before anything runs."""
