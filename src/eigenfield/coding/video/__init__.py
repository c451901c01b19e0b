"""Pictures of 10-bit Y'CbCr as an AV1 stream."""
