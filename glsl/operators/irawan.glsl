// Irawan, Ferwerda and Marschner 2005, reconstructed: histogram adjustment under the thresholds of an eye that
// adapts over time.

#ifdef OPERATOR_FRAMES

void irawan_frame(Frame frame) { adjusted_curve(frame); }

#endif
