#pragma once
#include <stdexcept>
#include <string>

namespace tss {

/// Where in the input something is wrong. Empty members are not known or do not apply.
struct Where {
    std::string file{};    ///< file name as the user gave it
    std::string pointer{}; ///< JSON pointer inside the file, e.g. /primChildren/0/properties/points
    std::string path{};    ///< prim or property path, e.g. /Jaw/Hinge.physics:lowerLimit
};

/// The input is at fault: what is wrong, where, and what was expected. The only exception that bake/ lets out
/// for bad input; a broken promise of the code itself is an assertion or std::logic_error.
class InputError : public std::runtime_error {
public:
    explicit InputError(const std::string& what) : std::runtime_error(what), message(what) {}
    InputError(Where where, const std::string& what)
        : std::runtime_error(text(where, what)), where(std::move(where)), message(what) {}

    Where where;
    std::string message; ///< without the place

private:
    static std::string text(const Where& where, const std::string& what) {
        std::string s = where.file;
        if (!where.pointer.empty()) s += (s.empty() ? "" : ": ") + where.pointer;
        if (!where.path.empty()) s += (s.empty() ? "<" : " (<") + where.path + (s.empty() ? ">" : ">)");
        return s.empty() ? what : s + ": " + what;
    }
};

/// Does the work on what a file holds: an InputError that does not know its file is told with it.
template <class Work>
auto inFile(const std::string& file, const Work& work) {
    try {
        return work();
    } catch (const InputError& error) {
        if (!error.where.file.empty()) throw;
        throw InputError(Where{file, error.where.pointer, error.where.path}, error.message);
    }
}

} // namespace tss
