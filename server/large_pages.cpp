#include "server/large_pages.h"

#include <sys/auxv.h>
#include <unistd.h>

#include <cstdlib>  // says which library this is
#include <filesystem>
#include <string>
#include <system_error>

namespace lpf::server {

void use_large_pages([[maybe_unused]] char** arguments) {
#ifdef __GLIBC__
    constexpr const char* kVariable = "GLIBC_TUNABLES";
    const char* value = std::getenv(kVariable);
    const std::string told = value ? value : "";
    if (told.find("glibc.malloc.hugetlb=") != std::string::npos) return;
    // A program with rights of its own is started without the variable, and would never end.
    if (::getauxval(AT_SECURE) != 0) return;
    std::error_code error;
    const std::string program = std::filesystem::read_symlink("/proc/self/exe", error).string();
    if (error) return;
    const std::string option = "glibc.malloc.hugetlb=1";
    const std::string tell = told.empty() ? option : option + ":" + told;
    if (::setenv(kVariable, tell.c_str(), 1) != 0) return;
    ::execv(program.c_str(), arguments);  // goes on here if it cannot
#endif
}

}  // namespace lpf::server
