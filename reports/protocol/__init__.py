"""The protocol of a kind of scene, how it is run and compared; and the list of kinds."""
