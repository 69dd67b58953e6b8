"""Where assemblies meet: found, signed, and gone through smoothly."""
