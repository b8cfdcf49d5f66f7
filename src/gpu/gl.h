// OpenGL 4.5 core entry points, exported by libOpenGL.
#pragma once

#define GL_GLEXT_PROTOTYPES 1
#include <GL/glcorearb.h>
