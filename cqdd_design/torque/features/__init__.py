"""What a network sees of an episode."""
