"""What the motion asks of the joints."""
