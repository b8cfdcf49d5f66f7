#version 450 core
// Does nothing with no resource: after it, the driver holds none of those of earlier dispatches.
layout(local_size_x = 1) in;
void main() {}
