// What child_test.cpp has done in a process of its own.
#include "base/child.h"
#include "base/error.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace {

using Words = std::vector<std::string>;

std::string echo(const Words& words, std::string input) {
  std::string all;
  for (const std::string& word : words) all += word + "|";
  return all + input;
}

std::string complain(const Words& words, std::string) {
  throw gnomon::WorldError(words.at(0));
}

std::string complainOddly(const Words& words, std::string) {
  throw std::runtime_error(words.at(0));
}

std::string beKilled(const Words&, std::string) {
  std::raise(SIGKILL);
  return "";
}

std::string crash(const Words&, std::string) {
  std::fputs("a library's last words\n", stderr);
  std::fflush(stderr);
  std::raise(SIGSEGV);
  return "";
}

std::string compute(const Words&, std::string) {
  for (std::atomic<int> i = 0;; ++i) {
  }
}

std::string wait(const Words&, std::string) {
  std::this_thread::sleep_for(std::chrono::seconds(60));
  return "";
}

std::string fill(const Words& bytes, std::string) {
  return std::string(std::stoull(bytes.at(0)), 'x');
}

// What the system says to a call: "done", or why not.
std::string tryCall(const Words& words, std::string) {
  const std::map<std::string, std::function<long()>> calls{
      {"make a file", [&] { return ::open(words.at(1).c_str(), O_CREAT | O_WRONLY, 0600); }},
      {"open a file", [] { return ::open("/etc/passwd", O_RDONLY); }},
      {"connect", [] { return ::socket(AF_INET, SOCK_STREAM, 0); }},
      {"fork", [] { return ::fork(); }},
      {"signal", [] { return ::kill(::getppid(), 0); }},
      {"remove a file", [] { return ::unlink("/nowhere"); }},
      {"run what it writes",
       [] {
         void* page = ::mmap(nullptr, 4096, PROT_READ | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
         return page == MAP_FAILED ? -1 : 0;
       }},
      {"write elsewhere", [] { return ::write(5, "x", 1); }},
      {"read elsewhere",
       [] {
         char byte = 0;
         return ::read(6, &byte, 1);
       }},
  };
  errno = 0;
  return calls.at(words.at(0))() < 0 ? std::strerror(errno) : "done";
}

}  // namespace

int main(int argc, char** argv) {
  return gnomon::runAsChild(argc, argv,
                            {{"echo", echo},
                             {"complain", complain},
                             {"complain oddly", complainOddly},
                             {"crash", crash},
                             {"be killed", beKilled},
                             {"compute", compute},
                             {"wait", wait},
                             {"fill", fill},
                             {"try", tryCall}});
}
