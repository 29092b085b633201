"""Symbolic execution of LLVM IR: a callback compiled by clang, run on symbolic inputs."""
