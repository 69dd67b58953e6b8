"""Other processes: isolated children, their scheduler, signals, programs."""
