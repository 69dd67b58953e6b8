"""What theory says of a whole mechanism."""
