#include "bake/base/AtomicFile.h"
#include "tests/extreme/Served.h"

#include <filesystem>

using namespace extreme;

TEST_CASE("the files under scenes/extreme are those that tss-extreme writes, and no others") {
    const std::filesystem::path folder = OSGTSS_SOURCE_DIR "/scenes/extreme";
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) files += entry.is_regular_file();
    CHECK(files == extremeScenes().size());
    for (const ExtremeScene& scene : extremeScenes()) {
        INFO(scene.name);
        CHECK(tss::readWholeFile((folder / (scene.name + ".tss")).string()) == scene.text);
    }
}

TEST_CASE("every extreme scene is served as it must be, its bounds proven, or refused with its place") {
    for (const ExtremeScene& scene : extremeScenes()) {
        const Outcome& outcome = served(scene.name);
        INFO(scene.name << ": " << outcome.refusal);
        for (const std::string& trouble : outcome.troubles) FAIL_CHECK(scene.name << ": " << trouble);
        switch (scene.fate) {
        case Fate::Table:
            REQUIRE(outcome.refusal.empty());
            CHECK(outcome.scene.pairs.at(0).table);
            CHECK(outcome.pairs.at(0).verdict.holds());
            break;
        case Fate::NeverMeet:
            REQUIRE(outcome.refusal.empty());
            CHECK(outcome.scene.pairs.at(0).proof);
            CHECK(outcome.pairs.at(0).verdict.holds());
            break;
        case Fate::Skin:
            REQUIRE(outcome.refusal.empty());
            CHECK(outcome.scene.skins.at(0).table);
            break;
        case Fate::NotReadable:
            CHECK_FALSE(outcome.read);
            CHECK(outcome.refusal.find(scene.refusal) != std::string::npos);
            CHECK(outcome.refusal.find(scene.name + ".tss: /") == 0); // the file and the JSON pointer
            break;
        case Fate::NotBakeable:
            CHECK(outcome.read);
            CHECK(outcome.refusal.find(scene.refusal) != std::string::npos);
            CHECK(outcome.refusal.find("</Scene/") != std::string::npos);
            break;
        }
    }
}
