/// Long work for Python: without the interpreter's lock, on as many threads as asked for, and stopped by Ctrl-C within 50 ms.
#pragma once
#include <pybind11/pybind11.h>

#include <functional>
#include <optional>
#include <type_traits>
#include <utility>

namespace interreflect::bindings {
namespace py = pybind11;

/// How many threads work of this Python thread may use; 0: all.
int& thread_limit();

/// Runs `work` to its end on another thread and waits for it; rethrows what it throws. On a signal that Python turns into an
/// exception (Ctrl-C) its parallel loops are cancelled and that exception is thrown.
void run_interruptible(const std::function<void()>& work);

/// The same for work with a result.
template <class Work>
auto run(Work&& work) {
    using Result = decltype(work());
    if constexpr (std::is_void_v<Result>) {
        run_interruptible(work);
    } else {
        std::optional<Result> result;
        run_interruptible([&] { result.emplace(work()); });
        return std::move(*result);
    }
}

}  // namespace interreflect::bindings
