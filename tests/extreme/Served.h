#pragma once
#include "tests/extreme/scenes/ExtremeScene.h"
#include "tests/extreme/tool/Serve.h"

#include <catch2/catch.hpp>
#include <map>

/// What became of an extreme scene; each is served once a run of the tests.
inline const extreme::Outcome& served(const std::string& name) {
    static std::map<std::string, extreme::Outcome> known;
    const auto at = known.find(name);
    if (at != known.end()) return at->second;
    return known.emplace(name, extreme::serve(extreme::extremeScene(name).text, name)).first->second;
}

/// The table of a served scene's one pair.
inline const tss::Table& tableOf(const std::string& name) {
    const extreme::Outcome& outcome = served(name);
    INFO(name << ": " << outcome.refusal);
    REQUIRE(outcome.refusal.empty());
    REQUIRE(outcome.scene.pairs.size() == 1);
    REQUIRE(outcome.scene.pairs[0].table);
    return *outcome.scene.pairs[0].table;
}
