#include "server/gate/peer.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace lpf::gate {
namespace {

std::string client(const TrustedProxies& proxies, const std::string& peer,
                   const std::string& forwarded) {
    const auto address = proxies.client(Address::parse(peer), forwarded);
    return address ? address->owner() : "nobody";
}

TEST(TrustedProxies, OnlyTheirWordIsTaken) {
    const TrustedProxies nobody({});
    EXPECT_EQ(client(nobody, "10.0.0.5", "1.2.3.4"), "10.0.0.5");
    const TrustedProxies some({"10.0.0.0/24", "::1"});
    EXPECT_EQ(client(some, "10.0.0.5", "1.2.3.4"), "1.2.3.4");
    EXPECT_EQ(client(some, "10.0.1.5", "1.2.3.4"), "10.0.1.5");
    EXPECT_EQ(client(some, "::ffff:10.0.0.5", "9.9.9.9, 1.2.3.4"), "1.2.3.4");
    EXPECT_EQ(client(some, "::1", "9.9.9.9, 1.2.3.4:5555, 10.0.0.7"), "1.2.3.4");
    EXPECT_EQ(client(some, "10.0.0.5", "1.2.3.4, nonsense"), "10.0.0.5");
    EXPECT_EQ(client(some, "10.0.0.5", ""), "10.0.0.5");
}

TEST(TrustedProxies, WrongNetworksAreRefused) {
    for (const char* text :
         {"", "proxy.example", "10.0.0.0/33", "10.0.0.0/", "10.0.0.0/x", "::/129"})
        EXPECT_THROW(TrustedProxies({text}), Error) << text;
}

TEST(Address, AnOwnerOfIpv6HasANetwork) {
    EXPECT_EQ(Address::parse("2001:db8::1")->owner(), Address::parse("[2001:db8::ff]:80")->owner());
    EXPECT_NE(Address::parse("2001:db8::1")->owner(), Address::parse("2001:db8:0:1::1")->owner());
    EXPECT_TRUE(Address::parse("127.1.2.3")->is_loopback());
    EXPECT_TRUE(Address::parse("::1")->is_loopback());
    EXPECT_FALSE(Address::parse("128.0.0.1")->is_loopback());
    EXPECT_FALSE(Address::parse("somewhere"));
}

}  // namespace
}  // namespace lpf::gate
