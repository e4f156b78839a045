#include "TableCache.h"

#include "bake/model/SourceHash.h"
#include "bake/scene/SceneFile.h"

#include <osg/Notify>

#include <algorithm>
#include <filesystem>

namespace osgTSS {

namespace {

bool isBaked(const tss::Pair& pair) {
    return pair.table || pair.proof;
}
bool isBaked(const tss::SkinModel& skin) {
    return bool(skin.table);
}

/// The same for pairs and for skins: their results where they were baked with the same settings from the same
/// things, whatever they are called: joints without names are numbered, and a file may have them in another
/// order since. Returns how many.
template <class Items>
std::size_t take(const tss::SceneModel& model, Items& items, const Items& cached) {
    std::size_t taken = 0;
    for (auto& item : items) {
        const std::string hash = tss::sourceHash(model, item);
        const auto old = std::ranges::find_if(cached, [&](const auto& other) {
            return isBaked(other) && other.sourceHash == hash && other.settings == item.settings;
        });
        if (old == cached.end()) continue;
        item.table = old->table;
        if constexpr (requires { item.proof; }) item.proof = old->proof;
        item.sourceHash = hash;
        ++taken;
    }
    return taken;
}

} // namespace

std::size_t TableCache::takeInto(tss::SceneModel& model) const {
    std::error_code failed;
    if (_file.empty() || !std::filesystem::exists(_file, failed)) return 0;
    try {
        const tss::SceneModel cached = tss::loadScene(_file);
        const std::size_t pairs = take(model, model.pairs, cached.pairs);
        return pairs + take(model, model.skins, cached.skins);
    } catch (const std::exception& error) {
        OSG_WARN << "osgTSS: " << _file << " is baked anew: " << error.what() << std::endl;
        return 0;
    }
}

void TableCache::save(const tss::SceneModel& model) {
    if (_file.empty()) return;
    try {
        tss::saveScene(model, _file);
    } catch (const std::exception& error) {
        OSG_NOTICE << "osgTSS: the tables are not kept for the next time: " << error.what() << std::endl;
    }
    _saved = Time::now();
}

void TableCache::saveNowAndThen(const tss::SceneModel& model) {
    constexpr auto every = std::chrono::seconds(10);
    if (Time::now() - _saved >= every) save(model);
}

} // namespace osgTSS
