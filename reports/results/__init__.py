"""What stored cells say."""
