// Durand and Dorsey 2000, reconstructed: gains of cones and rods of an eye that adapts over time, also to colour. Its
// pixels are mapped as those of ferwerda.

#ifdef OPERATOR_FRAMES

void durand_frame(Frame frame) { gains_frame(frame); }

#endif
