#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace lpf::server {

/// The file of a web folder that a path names ("/" is index.html), or nothing. Only plain names
/// made of letters, digits, '.', '-' and '_' that do not start with a dot; nothing outside of the
/// folder, not even through a link.
[[nodiscard]] std::optional<std::filesystem::path> web_file(const std::filesystem::path& folder,
                                                            std::string_view path);

/// The folder in which the build or an installation puts the page, share/lpf-server/web beside the
/// bin/ of the executable; empty if there is none.
[[nodiscard]] std::filesystem::path web_dir_of(const std::filesystem::path& executable);

/// Media type by the ending of a name.
[[nodiscard]] std::string_view web_type(const std::filesystem::path& file);

/// The page for a server without a web folder: what this is, and the one line that tries it.
[[nodiscard]] std::string plain_index(std::string_view version);

}  // namespace lpf::server
