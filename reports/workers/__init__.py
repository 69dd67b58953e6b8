"""Other processes: isolated children, pools, signals, programs."""
