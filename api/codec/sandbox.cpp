#include "api/codec/sandbox.h"

#include <seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>

#include "api/codec/text.h"

namespace lpf {
namespace {

void limit(int resource, std::uint64_t value) {
    const rlimit bound{value, value};
    if (setrlimit(static_cast<__rlimit_resource>(resource), &bound) != 0) {
        fail(ErrorCode::Internal, "lpf-decode: cannot limit resource ", resource);
    }
}

#ifndef LPF_SANITIZED
void allow_memory_without_code(scmp_filter_ctx filter, int call) {
    // No page becomes executable any more. The protection is the third argument of both calls.
    seccomp_rule_add(filter, SCMP_ACT_ALLOW, call, 1,
                     SCMP_A2(SCMP_CMP_MASKED_EQ, static_cast<scmp_datum_t>(PROT_EXEC), 0));
}

/// Computing, memory, and the streams that are open. A kernel without filters runs without.
void filter_system_calls() {
    scmp_filter_ctx filter = seccomp_init(SCMP_ACT_KILL_PROCESS);
    if (filter == nullptr) throw Error(ErrorCode::OutOfMemory, "lpf-decode: no memory");
    for (const int call :
         {SCMP_SYS(read), SCMP_SYS(write), SCMP_SYS(lseek), SCMP_SYS(fstat), SCMP_SYS(newfstatat),
          SCMP_SYS(brk), SCMP_SYS(munmap), SCMP_SYS(mremap), SCMP_SYS(madvise), SCMP_SYS(futex),
          SCMP_SYS(getrandom), SCMP_SYS(clock_gettime), SCMP_SYS(getpid), SCMP_SYS(gettid),
          SCMP_SYS(rt_sigprocmask), SCMP_SYS(rt_sigreturn), SCMP_SYS(exit), SCMP_SYS(exit_group)}) {
        seccomp_rule_add(filter, SCMP_ACT_ALLOW, call, 0);
    }
    allow_memory_without_code(filter, SCMP_SYS(mmap));
    allow_memory_without_code(filter, SCMP_SYS(mprotect));
    // abort() raises a signal in this process; no other may get one.
    seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(tgkill), 1,
                     SCMP_A0(SCMP_CMP_EQ, static_cast<scmp_datum_t>(getpid())));
    (void)seccomp_load(filter);
    seccomp_release(filter);
}
#endif

}  // namespace

void confine_this_process(const SandboxLimits& limits) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, limits.cpu_seconds);
    alarm(limits.wall_seconds);
#ifndef LPF_SANITIZED
    limit(RLIMIT_AS, limits.memory_bytes);
    limit(RLIMIT_FSIZE, limits.memory_bytes);
    limit(RLIMIT_NOFILE, 3);
    filter_system_calls();
#endif
}

}  // namespace lpf
