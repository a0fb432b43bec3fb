"""What balls do in the end: the motions on which they end, and how they are told apart."""
