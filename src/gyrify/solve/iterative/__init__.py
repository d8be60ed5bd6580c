"""Linear systems of bodies in space by conjugate gradients: without a factor, which would fill memory."""
