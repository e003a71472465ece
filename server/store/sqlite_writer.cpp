#include "server/store/sqlite_writer.h"

#include <utility>

namespace lpf::server {

void SqliteWriter::run(Task& task) {
    std::unique_lock lock(mutex_);
    waiting_.push_back(&task);
    done_.wait(lock, [&] { return task.done || !busy_; });
    if (!task.done) {
        busy_ = true;
        const std::vector<Task*> tasks = std::exchange(waiting_, {});
        lock.unlock();
        write_together(tasks);
        lock.lock();
        for (Task* each : tasks) each->done = true;
        busy_ = false;
        done_.notify_all();
    }
    lock.unlock();
    if (task.error) std::rethrow_exception(task.error);
}

void SqliteWriter::write_together(const std::vector<Task*>& tasks) {
    try {
        SqlTransaction transaction(db_);
        for (Task* task : tasks) write_one(*task);
        transaction.commit();
    } catch (...) {  // nothing of this was kept
        for (Task* task : tasks)
            if (!task->error) task->error = std::current_exception();
    }
}

void SqliteWriter::write_one(Task& task) {
    db_.script("SAVEPOINT one");
    try {
        task.change(db_);
    } catch (...) {
        task.error = std::current_exception();
        undo_one(task);
    }
    db_.script("RELEASE one");
}

void SqliteWriter::undo_one(const Task& task) {
    try {
        db_.script("ROLLBACK TO one");
    } catch (...) {  // SQLite has given up the whole transaction, for the reason that the task had
        std::rethrow_exception(task.error);
    }
}

}  // namespace lpf::server
