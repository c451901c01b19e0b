"""A mesh's atlas: checked, or cut anew."""
