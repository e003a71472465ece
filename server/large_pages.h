#pragma once

namespace lpf::server {

/// Has the allocator ask the kernel for large pages (madvise), by starting the program once more:
/// glibc wants to know before main. A page is then handed out 512 times less often, which is as
/// much as a fifth of a job's time where the machine is a virtual one. The process keeps its
/// number. Does nothing where glibc has been told already, by this or by whoever runs the server
/// (GLIBC_TUNABLES, glibc.malloc.hugetlb), or cannot be told. To be called while there is one
/// thread and nothing is open. @param arguments those of main
void use_large_pages(char** arguments);

}  // namespace lpf::server
