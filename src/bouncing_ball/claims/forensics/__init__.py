"""What the authors may have computed: Table 1 under every reading we could think of."""
