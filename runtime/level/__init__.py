"""One level: means over its strips, the curve over penetration, and its friction law."""
