"""A program without ROS around one callback: generated, compiled, run natively, fuzzed, handed to KLEE."""
