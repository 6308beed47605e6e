"""Forms: energies and works as plain UFL functions; they know no mesh and no solver."""
