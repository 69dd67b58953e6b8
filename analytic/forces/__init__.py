"""What the motion asks of the joints and of the drive."""
