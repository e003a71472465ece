#include "server/gate/peer.h"

#include <arpa/inet.h>

#include <algorithm>
#include <charconv>
#include <cstring>

#include "api/http_text.h"
#include "core/base/error.h"

namespace lpf::gate {
namespace {

constexpr std::array<unsigned char, 12> kIpv4Prefix{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff};
constexpr std::size_t kLongestAddress = 64;

/// "[::1]:80" -> "::1", "1.2.3.4:80" -> "1.2.3.4"
std::string_view without_port(std::string_view text) {
    if (text.starts_with('[')) return text.substr(1, text.find(']') - 1);
    const auto colon = text.find(':');
    if (colon != std::string_view::npos && text.find(':', colon + 1) == std::string_view::npos)
        return text.substr(0, colon);
    return text;
}

}  // namespace

std::optional<Address> Address::parse(std::string_view text) {
    const std::string plain(without_port(trim(text)));
    if (plain.empty() || plain.size() > kLongestAddress) return std::nullopt;
    Address address;
    if (::inet_pton(AF_INET6, plain.c_str(), address.bytes_.data()) == 1) return address;
    std::copy(kIpv4Prefix.begin(), kIpv4Prefix.end(), address.bytes_.begin());
    if (::inet_pton(AF_INET, plain.c_str(), address.bytes_.data() + 12) == 1) return address;
    return std::nullopt;
}

bool Address::is_ipv4() const {
    return std::equal(kIpv4Prefix.begin(), kIpv4Prefix.end(), bytes_.begin());
}

bool Address::is_loopback() const {
    static constexpr std::array<unsigned char, 16> kOne{0, 0, 0, 0, 0, 0, 0, 0,
                                                        0, 0, 0, 0, 0, 0, 0, 1};
    return is_ipv4() ? bytes_[12] == 127 : bytes_ == kOne;
}

bool Address::shares_prefix(const Address& other, int bits) const {
    const auto whole = static_cast<std::size_t>(bits / 8);
    if (!std::equal(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(whole),
                    other.bytes_.begin()))
        return false;
    const int rest = bits % 8;
    return rest == 0 || (bytes_[whole] ^ other.bytes_[whole]) >> (8 - rest) == 0;
}

std::string Address::owner() const {
    auto bytes = bytes_;
    char text[INET6_ADDRSTRLEN] = {};
    if (is_ipv4()) {
        ::inet_ntop(AF_INET, bytes.data() + 12, text, sizeof(text));
        return text;
    }
    std::fill(bytes.begin() + 8, bytes.end(), static_cast<unsigned char>(0));
    ::inet_ntop(AF_INET6, bytes.data(), text, sizeof(text));
    return std::string(text) + "/64";
}

Network Network::parse(const std::string& text) {
    Network network;
    const auto slash = text.find('/');
    const auto base = Address::parse(text.substr(0, slash));
    bool right = base.has_value();
    if (base) network.base_ = *base;
    if (right && slash != std::string::npos) {
        const char* begin = text.data() + slash + 1;
        const char* end = text.data() + text.size();
        int bits = -1;
        const auto [stop, error] = std::from_chars(begin, end, bits);
        const int before = base->is_ipv4() ? 96 : 0;
        right = error == std::errc() && stop == end && bits >= 0 && bits <= 128 - before;
        network.bits_ = before + bits;
    }
    if (!right) {
        throw Error(ErrorCode::InvalidParameter,
                    "'" + text +
                        "' is no address. A trusted proxy is an address such as 10.0.0.5, "
                        "or a block such as 10.0.0.0/24.");
    }
    return network;
}

TrustedProxies::TrustedProxies(const std::vector<std::string>& networks) {
    for (const std::string& text : networks) networks_.push_back(Network::parse(text));
}

bool TrustedProxies::holds(const Address& address) const {
    return std::any_of(networks_.begin(), networks_.end(),
                       [&](const Network& network) { return network.holds(address); });
}

std::optional<Address> TrustedProxies::client(const std::optional<Address>& peer,
                                              std::string_view forwarded) const {
    std::optional<Address> client = peer;
    while (client && holds(*client) && !forwarded.empty()) {
        const auto comma = forwarded.rfind(',');
        const auto hop = Address::parse(
            comma == std::string_view::npos ? forwarded : forwarded.substr(comma + 1));
        if (!hop) break;
        client = hop;
        forwarded =
            comma == std::string_view::npos ? std::string_view{} : forwarded.substr(0, comma);
    }
    return client;
}

}  // namespace lpf::gate
