"""The claims of Carbonelli, Perret-Liaudet, Rigaud and Feki (2011), section by section."""
