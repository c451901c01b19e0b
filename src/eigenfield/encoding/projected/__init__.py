"""The paper's way: photographs projected into texture maps (its section 3.2), their mean and eigen textures (3.3)."""
