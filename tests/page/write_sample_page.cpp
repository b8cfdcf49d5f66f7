// write_sample_page FILE: a page of a result that nobody made, for the test in a browser.
#include <cstdio>

#include "core/atomic_file.h"
#include "core/error.h"
#include "sample_page.h"

int main(int count, char** words) {
  using namespace photohull;
  if (count != 2) {
    std::fputs("write_sample_page FILE\n", stderr);
    return 2;
  }
  try {
    const TriMesh mesh = test::wrinkled_ball(60);
    write_atomically(words[1],
                     page::make_page(test::sample_report(mesh), "photohull reconstruct 'a b'",
                                     test::sample_shown(mesh)));
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
