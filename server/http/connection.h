#pragma once

#include <httplib.h>

#include <chrono>
#include <string>

#include "server/http/listener.h"

namespace lpf::http {

/// An accepted socket as the transport library's stream. Waits with poll(), so that descriptors
/// above 1023 keep their time-outs, and gives out first what was put in front: the head it may see.
class Connection : public httplib::Stream {
public:
    Connection(int socket, const ListenerOptions& options);

    /// Reads up to the end of the head within the head deadline.
    /// @throws ProblemException 408 when it takes too long, 431 when it is too large
    /// @returns the head, or an empty text when the client left without a request
    std::string read_head();

    /// What the stream gives out before the bytes that follow the real head.
    void put_in_front(const std::string& head) { buffered_ = head + buffered_; }

    /// Sends a whole answer, without the transport library.
    void send(const Response& response);

    /// Says goodbye: ends the sending side and swallows, for a short while, what the client is
    /// still sending; closing at once would reset the connection and could take the answer with it.
    void linger();

    /// True when the client has closed its side.
    [[nodiscard]] bool abandoned() const;

    [[nodiscard]] bool is_readable() const override;
    [[nodiscard]] bool is_writable() const override;
    ssize_t read(char* data, size_t size) override;
    ssize_t write(const char* data, size_t size) override;
    void get_remote_ip_and_port(std::string& ip, int& port) const override;
    void get_local_ip_and_port(std::string& ip, int& port) const override;
    [[nodiscard]] socket_t socket() const override { return socket_; }

private:
    int socket_;
    const ListenerOptions& options_;
    std::chrono::steady_clock::time_point body_deadline_;
    std::string buffered_;  // bytes to give out before those of the socket
};

/// The time as the Date header has it.
[[nodiscard]] std::string http_date();

}  // namespace lpf::http
