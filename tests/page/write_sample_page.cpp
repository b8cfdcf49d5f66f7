// write_sample_page FILE [RINGS]: a page of a result that nobody made, for the test in a browser;
// with a number of rings a textured one, of twice their square of triangles.
#include <cstdio>
#include <cstdlib>

#include "core/atomic_file.h"
#include "core/error.h"
#include "sample_page.h"

int main(int count, char** words) {
  using namespace photohull;
  if (count != 2 && count != 3) {
    std::fputs("write_sample_page FILE [RINGS]\n", stderr);
    return 2;
  }
  try {
    const TriMesh mesh = test::wrinkled_ball(count == 3 ? std::atoi(words[2]) : 60);
    write_atomically(
        words[1],
        page::make_page(test::sample_report(mesh), "photohull reconstruct 'a b'",
                        count == 3 ? test::textured_shown(mesh) : test::sample_shown(mesh)));
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
