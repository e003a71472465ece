#pragma once

#include <memory>
#include <string_view>

#include "server/http/message.h"

namespace lpf::http {

/// Inflates a gzip body piece by piece, in constant memory: the transport library's own way knows
/// no limit.
class Inflater {
public:
    Inflater();
    ~Inflater();
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;

    /// @returns false if the sink wanted no more
    /// @throws ProblemException 400 for what is no gzip
    bool add(std::string_view compressed, const BodySink& sink);

    /// True at the end of a member: all that was promised has come.
    [[nodiscard]] bool finished() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace lpf::http
