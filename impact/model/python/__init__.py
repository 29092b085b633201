"""Names of Python resolved across files and into what packages offer."""
