#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "api/input_binding.h"
#include "api/job_inputs.h"
#include "api/parameters.h"
#include "api/problem.h"

namespace lpf {

/// Reads inputs one by one against the table of parameters and collects every fault on the way.
class InputReader {
public:
    /// @param pointer where the inputs lie in the request, for the faults
    InputReader(Task task, const Limits& limits, std::string pointer);

    void read(std::string_view name, const nlohmann::json& value);
    void read_text(std::string_view name, std::string_view text);

    /// A fault of the input `name`, or of the whole object if the name is empty.
    void fault(std::string_view name, std::string detail);

    /// Checks what concerns several inputs together.
    /// @throws ProblemException{InvalidParameter} if there was any fault
    [[nodiscard]] JobInputs finish();

private:
    [[nodiscard]] const Parameter* find(std::string_view name);
    void keep_number(const Parameter& parameter, double value, std::string_view shown);
    void keep_text(const Parameter& parameter, std::string_view text);
    void wrong(const Parameter& parameter, std::string_view shown);
    void check_together();

    Task task_;
    std::string pointer_;
    std::vector<Parameter> all_;
    JobInputs inputs_;
    std::vector<FieldError> faults_;
};

/// A name as one step of a JSON pointer (RFC 6901): "a/b" -> "/a~1b".
[[nodiscard]] std::string pointer_step(std::string_view name);

/// What a parameter takes, in words: "an integer from 5 to 12849".
[[nodiscard]] std::string expectation(const Parameter& parameter);

}  // namespace lpf
