#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <string>

namespace lpf::server {

/// A client without manners: sends any bytes, and reads until the server closes.
class RawClient {
public:
    explicit RawClient(int port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(static_cast<std::uint16_t>(port));
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        const timeval patience{10, 0};
        ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
        connected_ =
            ::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof(address)) == 0;
    }
    ~RawClient() { ::close(socket_); }
    RawClient(const RawClient&) = delete;
    RawClient& operator=(const RawClient&) = delete;

    [[nodiscard]] bool connected() const { return connected_; }

    /// @returns false once the server takes no more
    bool send(const std::string& text) const {
        std::size_t sent = 0;
        while (sent < text.size()) {
            const auto n = ::send(socket_, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
            if (n <= 0) return false;
            sent += static_cast<std::size_t>(n);
        }
        return true;
    }

    /// Ends the sending side.
    void end() const { ::shutdown(socket_, SHUT_WR); }

    [[nodiscard]] std::string read_all() const {
        std::string text;
        std::array<char, 4096> chunk{};
        for (;;) {
            const auto n = ::recv(socket_, chunk.data(), chunk.size(), 0);
            if (n <= 0) return text;
            text.append(chunk.data(), static_cast<std::size_t>(n));
        }
    }

    /// Sends everything, and reads the answer up to the server's end.
    [[nodiscard]] std::string ask(const std::string& text) const {
        send(text);
        end();
        return read_all();
    }

    /// Reads until `mark` has come; an empty text if it does not.
    [[nodiscard]] std::string read_until(const std::string& mark) const {
        std::string text;
        while (text.find(mark) == std::string::npos) {
            char c = 0;
            if (::recv(socket_, &c, 1, 0) <= 0) return {};
            text += c;
        }
        return text;
    }

    /// What the client does not read stays with the server: a small window.
    void read_little() const {
        const int bytes = 4096;
        ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof(bytes));
    }

private:
    int socket_;
    bool connected_ = false;
};

/// Status of an answer; 0 if there is none.
[[nodiscard]] inline int status_of(const std::string& answer) {
    return answer.starts_with("HTTP/1.1 ") ? std::stoi(answer.substr(9, 3)) : 0;
}

}  // namespace lpf::server
