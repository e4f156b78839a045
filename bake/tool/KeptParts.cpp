#include "bake/tool/KeptParts.h"

#include "bake/scene/SceneFile.h"

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <utility>

namespace tss::tool {

namespace {

/// Seconds between two writes of the incomplete file, at least, and times what a write takes, so that a large
/// one is not written most of the time: what may be lost where the program is killed.
constexpr double keepEvery = 60, keepTimes = 30;

volatile std::sig_atomic_t received = 0; ///< the signal that came; 0: none

void receive(int signal) {
    received = signal;
}

void install(void (*handler)(int)) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = static_cast<int>(SA_RESETHAND); // the second ends the program
    sigemptyset(&action.sa_mask);
    for (const int signal : {SIGINT, SIGTERM}) {
        struct sigaction before {};
        sigaction(signal, nullptr, &before);
        if (before.sa_handler != SIG_IGN)
            sigaction(signal, &action, nullptr); // as nohup and shells' & want it
    }
}

bool hasTable(const SceneModel& scene) {
    for (const Pair& pair : scene.pairs)
        if (pair.table || pair.proof) return true;
    for (const SkinModel& skin : scene.skins)
        if (skin.table) return true;
    return false;
}

/// A name of an incomplete file that does not exist yet: one of an earlier bake may hold more than this one
/// will.
std::string freeName(const std::string& output) {
    std::string name = incompleteName(output);
    std::error_code none;
    for (int k = 2; std::filesystem::exists(name, none); ++k) name = incompleteName(output, k);
    return name;
}

} // namespace

std::string incompleteName(const std::string& output, int number) {
    std::filesystem::path path(output);
    const std::string extension = path.extension().string();
    path.replace_extension();
    return path.string() + ".incomplete" + (number > 1 ? std::to_string(number) : "") + extension;
}

KeptParts::KeptParts(SceneModel& scene, const std::string& input, std::string output, BakeTimes times,
                     const Console& console)
    : scene_(scene), output_(std::move(output)), times_(std::move(times)), console_(console),
      nextKept_(keepEvery) {
    std::error_code none;
    kept_ = std::filesystem::equivalent(input, incompleteName(output_), none);
    incomplete_ = kept_ ? incompleteName(output_) : freeName(output_);
}

KeptParts::~KeptParts() {
    release();
}

void KeptParts::release() {
    if (std::exchange(holds_, false)) install(SIG_DFL);
}

void KeptParts::run(BakeRequest request) {
    if (!std::exchange(holds_, true)) {
        received = 0;
        install(receive);
    }
    request.done = [&](const PairReport& report) { done(report); };
    request.failed = [&](const InputError& error) { failures_.push_back(error); };
    request.interrupted = [] { return received != 0; };
    bake(scene_, request, console_.progress());
    signal_ = received;
    request.onlyMissing = true;
    const std::vector<std::string> missing = pathsToBake(scene_, request);
    missing_.insert(missing_.end(), missing.begin(), missing.end());
    if (missing_.empty()) signal_ = 0; // it came too late to stop anything
}

void KeptParts::done(const PairReport& report) {
    bakedAny_ = true;
    times_[report.path] = report.seconds;
    for (const std::string& note : report.notes) {
        console_.say(report.path + ": " + note);
        notes_[report.path].push_back(note);
    }
    if (sinceKept_.seconds() < nextKept_) return;
    const Stopwatch writing;
    try {
        writeTo(incomplete_);
        kept_ = true;
    } catch (const InputError& error) { // there may be room again at the end
        console_.say(std::string("what is baked so far could not be kept: ") + error.what());
    }
    nextKept_ = std::max(keepEvery, keepTimes * writing.seconds());
    sinceKept_.restart();
}

std::string KeptParts::write() {
    if (!complete() && !hasTable(scene_)) {
        release();
        return {};
    }
    const std::string file = complete() ? output_ : incomplete_;
    writeTo(file);
    std::error_code none;
    if (complete() && kept_) std::filesystem::remove(incomplete_, none);
    release();
    return file;
}

void KeptParts::writeTo(const std::string& file) const {
    saveScene(scene_, file);
    writeBakeTimes(file, times_);
}

} // namespace tss::tool
