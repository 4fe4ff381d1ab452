#include "bindings/run.h"

#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>
#include <thread>

namespace interreflect::bindings {

int& thread_limit() {
    thread_local int limit = 0;
    return limit;
}

void run_interruptible(const std::function<void()>& work) {
    // Kept from call to call: a new arena for each leaves some 8 KiB behind (oneTBB 2021.8), which long studies add up.
    thread_local std::map<int, oneapi::tbb::task_arena> arenas;
    const int limit = thread_limit();
    auto& arena = arenas.try_emplace(limit, limit > 0 ? limit : int{oneapi::tbb::task_arena::automatic}).first->second;
    oneapi::tbb::task_group_context context(oneapi::tbb::task_group_context::isolated);
    std::exception_ptr failure;
    std::mutex mutex;
    std::condition_variable ended;
    bool done = false, interrupted = false;
    std::thread worker([&] {
        try {
            arena.execute([&] {
                oneapi::tbb::task_group group(context);
                group.run_and_wait([&] {
                    try {
                        work();
                    } catch (...) {
                        failure = std::current_exception();
                    }
                });
            });
        } catch (...) {
            failure = std::current_exception();
        }
        const std::lock_guard lock(mutex);
        done = true;
        ended.notify_one();
    });
    {
        py::gil_scoped_release unlocked;
        std::unique_lock lock(mutex);
        while (!ended.wait_for(lock, std::chrono::milliseconds(50), [&] { return done; })) {
            lock.unlock();
            if (!interrupted) {
                const py::gil_scoped_acquire locked;
                if (PyErr_CheckSignals() != 0) {
                    interrupted = true;
                    context.cancel_group_execution();
                }
            }
            lock.lock();
        }
        lock.unlock();
        worker.join();
    }
    if (interrupted) throw py::error_already_set();
    if (failure) std::rethrow_exception(failure);
}

}  // namespace interreflect::bindings
