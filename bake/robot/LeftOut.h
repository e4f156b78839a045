#pragma once
#include "bake/base/Words.h"

#include <map>
#include <string>
#include <vector>

namespace tss {

/// Names by what became of them, as notes: at most some a kind, and how many there are. What is added of one
/// name several times in a row is said once.
class LeftOut {
public:
    void add(const std::string& kind, const std::string& name) {
        std::vector<std::string>& names = names_[kind];
        if (names.empty() || names.back() != name) names.push_back(name);
    }

    std::vector<std::string> notes() const {
        constexpr std::size_t most = 4;
        std::vector<std::string> notes;
        for (const auto& [kind, names] : names_) notes.push_back(kind + ": " + firstOf(names, most));
        return notes;
    }

private:
    std::map<std::string, std::vector<std::string>> names_;
};

} // namespace tss
