#pragma once
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>

namespace tss {

/// Work in another process ended without a result; what() goes on from what it is: "crashes (signal 11)".
class SubprocessFailed : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// The bytes that the work makes, in a process of its own: other people's code that may crash, write to the
/// terminal or ask for any memory does so there. What it prints is dropped; memory: bytes that it may take
/// beyond those of this process. Throws what the work throws, if that is an InputError; SubprocessFailed.
std::string runInSubprocess(const std::function<std::string()>& work, std::size_t memory);

} // namespace tss
