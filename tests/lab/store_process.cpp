// Another process on a store, for store_test.cpp:
//   store_process fill STORE KEY SLOT    when standard input ends
//   store_process claim STORE WORK       says y or n, and keeps what it has until it is killed
#include "tests/lab/store_rows.h"

#include <unistd.h>

#include <cstdio>
#include <exception>
#include <string>

int main(int argc, char** argv) {
  using namespace gnomon;
  if (argc < 4) return 2;
  const std::string does = argv[1];
  try {
    if (does == "fill" && argc == 5) {
      while (std::getchar() != EOF) {
      }
      test::fill(argv[2], {test::rowOf(argv[3], argv[4])});
      return 0;
    }
    if (does == "claim") {
      Store store(argv[2], sql::Open::Existing);
      store.startWork(test::kMachine);
      std::puts(store.claim(argv[3]) ? "y" : "n");
      std::fflush(stdout);
      ::pause();
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 2;
}
