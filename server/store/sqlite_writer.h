#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <type_traits>
#include <vector>

#include "server/store/sqlite.h"

namespace lpf::server {

/// Writes to a database for many threads, with group commit: changes that come while the disk is
/// busy with others wait for it together, in one transaction.
class SqliteWriter {
public:
    explicit SqliteWriter(SqliteDatabase& db) : db_(db) {}

    /// Runs a change, which is durable when this returns. Changes run one after the other, each
    /// seeing those before it. One that throws is undone, alone; if the disk fails, all that were
    /// to be written together throw.
    template <typename Change>
    auto write(Change change) -> std::invoke_result_t<Change, SqliteDatabase&> {
        using Result = std::invoke_result_t<Change, SqliteDatabase&>;
        if constexpr (std::is_void_v<Result>) {
            Task task{.change = std::move(change)};
            run(task);
        } else {
            std::optional<Result> result;
            Task task{.change = [&](SqliteDatabase& db) { result.emplace(change(db)); }};
            run(task);
            return std::move(*result);
        }
    }

private:
    struct Task {
        std::function<void(SqliteDatabase&)> change;
        std::exception_ptr error = {};
        bool done = false;
    };

    void run(Task& task);
    void write_together(const std::vector<Task*>& tasks);
    void write_one(Task& task);
    void undo_one(const Task& task);

    SqliteDatabase& db_;
    std::mutex mutex_;
    std::condition_variable done_;
    std::vector<Task*> waiting_;
    bool busy_ = false;  // a thread writes for all that waited when it began
};

}  // namespace lpf::server
