"""What runs things: threads, compiled kernels, files, finished stages, object stores."""
