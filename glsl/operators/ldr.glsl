// No HDR: values in [0, 1] are shown as they are.

#ifdef OPERATOR_FRAMES

void ldr_frame(Frame frame) {}

#endif
