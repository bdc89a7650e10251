"""The live page: what an engine does, in a browser on the same host."""
