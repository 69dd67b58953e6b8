"""Second opinions, which share no arithmetic with the closed forms."""
