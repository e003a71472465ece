#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lpf::gate {

/// An IPv4 or IPv6 address. IPv4 is kept as ::ffff:a.b.c.d, so that both are one.
class Address {
public:
    /// Also reads what proxies write: "[::1]:80", "1.2.3.4:80".
    [[nodiscard]] static std::optional<Address> parse(std::string_view text);

    [[nodiscard]] bool is_loopback() const;
    /// Whether the first `bits` of 128 are those of `other`.
    [[nodiscard]] bool shares_prefix(const Address& other, int bits) const;
    [[nodiscard]] bool is_ipv4() const;

    /// Under which name limits are kept: the address, or of IPv6 the /64 that one customer has.
    [[nodiscard]] std::string owner() const;

private:
    std::array<unsigned char, 16> bytes_{};
};

/// An address or a block of them ("10.0.0.0/8").
class Network {
public:
    /// @throws Error{InvalidParameter} that says what would be right
    [[nodiscard]] static Network parse(const std::string& text);

    [[nodiscard]] bool holds(const Address& address) const {
        return address.shares_prefix(base_, bits_);
    }

private:
    Address base_;
    int bits_ = 128;
};

/// Proxies whose word about the client's address is taken.
class TrustedProxies {
public:
    /// @throws Error{InvalidParameter}
    explicit TrustedProxies(const std::vector<std::string>& networks);

    [[nodiscard]] bool holds(const Address& address) const;

    /// Who really asks: the peer; if that is a trusted proxy, the last address of X-Forwarded-For
    /// that is not one itself. What stands before it could have been made up by the client.
    /// @param forwarded values of all X-Forwarded-For fields, joined by commas
    [[nodiscard]] std::optional<Address> client(const std::optional<Address>& peer,
                                                std::string_view forwarded) const;

private:
    std::vector<Network> networks_;
};

}  // namespace lpf::gate
