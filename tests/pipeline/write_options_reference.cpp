// Prints docs/reference/options.md.
#include <cstdio>

#include "options_reference.h"

int main() { std::fputs(photohull::pipeline::options_reference().c_str(), stdout); }
