"""Generator of the *Rivoli* daytime street database; see ``data/rivoli/README.md``."""
