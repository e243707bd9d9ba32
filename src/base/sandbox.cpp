#include "base/sandbox.h"

#include "base/sanitizers.h"

#include <seccomp.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <initializer_list>

namespace gnomon {

namespace {

class Filter {
 public:
  Filter() : context_(::seccomp_init(SCMP_ACT_ERRNO(EPERM))) {
    // Threads that libraries began with, too.
    isWhole_ = isWhole_ && ::seccomp_attr_set(context_, SCMP_FLTATR_CTL_TSYNC, 1) == 0;
  }
  ~Filter() { ::seccomp_release(context_); }
  Filter(const Filter&) = delete;
  Filter& operator=(const Filter&) = delete;

  void allow(std::initializer_list<int> calls) {
    for (const int call : calls) add(call, {});
  }
  void allowWhere(int call, const scmp_arg_cmp& condition) { add(call, {condition}); }

  bool load() const { return isWhole_ && ::seccomp_load(context_) == 0; }

 private:
  void add(int call, std::initializer_list<scmp_arg_cmp> conditions) {
    isWhole_ = isWhole_ && ::seccomp_rule_add_array(context_, SCMP_ACT_ALLOW, call,
                                                    static_cast<unsigned>(conditions.size()), conditions.begin()) == 0;
  }

  scmp_filter_ctx context_;
  bool isWhole_ = context_ != nullptr;
};

scmp_arg_cmp argumentIs(unsigned argument, int value) {
  return {.arg = argument, .op = SCMP_CMP_EQ, .datum_a = static_cast<scmp_datum_t>(value), .datum_b = 0};
}

scmp_arg_cmp argumentLacks(unsigned argument, int bits) {
  return {.arg = argument, .op = SCMP_CMP_MASKED_EQ, .datum_a = static_cast<scmp_datum_t>(bits), .datum_b = 0};
}

}  // namespace

bool enterSandbox(int result) {
  Filter filter;
  filter.allow({SCMP_SYS(brk), SCMP_SYS(munmap), SCMP_SYS(mremap), SCMP_SYS(madvise)});
  for (const int call : {SCMP_SYS(mmap), SCMP_SYS(mprotect)}) filter.allowWhere(call, argumentLacks(2, PROT_EXEC));
  filter.allow({SCMP_SYS(read), SCMP_SYS(pread64), SCMP_SYS(lseek), SCMP_SYS(fstat), SCMP_SYS(close)});
  for (const int descriptor : {result, STDOUT_FILENO, STDERR_FILENO})
    filter.allowWhere(SCMP_SYS(write), argumentIs(0, descriptor));
  filter.allow({SCMP_SYS(clock_gettime), SCMP_SYS(gettimeofday), SCMP_SYS(times), SCMP_SYS(getrusage),
                SCMP_SYS(nanosleep), SCMP_SYS(clock_nanosleep), SCMP_SYS(getrandom)});
  filter.allow({SCMP_SYS(futex), SCMP_SYS(sched_yield), SCMP_SYS(sched_getaffinity), SCMP_SYS(getcpu), SCMP_SYS(getpid),
                SCMP_SYS(gettid), SCMP_SYS(rt_sigaction), SCMP_SYS(rt_sigprocmask), SCMP_SYS(rt_sigreturn),
                SCMP_SYS(sigaltstack)});
  // Of threads that libraries began with, and that have hardly begun.
  filter.allow({SCMP_SYS(rseq), SCMP_SYS(set_robust_list)});
  filter.allowWhere(SCMP_SYS(tgkill), argumentIs(0, ::getpid()));  // abort
  filter.allow({SCMP_SYS(exit), SCMP_SYS(exit_group)});
  // Sanitizers ask through a pipe what memory there is.
  if (kHasSanitizers) filter.allow({SCMP_SYS(pipe2), SCMP_SYS(write)});
  return filter.load();
}

}  // namespace gnomon
