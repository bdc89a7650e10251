"""The live page: the state of an engine, in a browser on the same host."""
