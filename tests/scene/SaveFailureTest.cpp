#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/scene/SceneFile.h"
#include "bake/scene/WriteLayer.h"
#include "tests/scene/Samples.h"

#include <catch2/catch.hpp>

#include <csignal>
#include <filesystem>
#include <sys/resource.h>
#include <unistd.h>

using namespace tss;
namespace fs = std::filesystem;

namespace {

/// A folder with one good scene in it.
struct SavedScene {
    fs::path folder = fs::path(OSGTSS_BINARY_DIR) / "savefailure";
    std::string file = (folder / "a.tss").string(), before;
    SavedScene() {
        fs::remove_all(folder);
        fs::create_directories(folder);
        saveScene(samples::jaw(), file);
        before = readWholeFile(file);
    }
    ~SavedScene() {
        fs::permissions(folder, fs::perms::owner_all);
        fs::remove_all(folder);
    }
    bool isUntouched() const {
        return readWholeFile(file) == before &&
               std::distance(fs::directory_iterator(folder), fs::directory_iterator()) == 1;
    }
};

/// No file grows beyond this size, as on a full disk.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        getrlimit(RLIMIT_FSIZE, &old_);
        const rlimit limit{bytes, old_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() {
        setrlimit(RLIMIT_FSIZE, &old_);
        std::signal(SIGXFSZ, handler_);
    }

private:
    void (*handler_)(int);
    rlimit old_{};
};

/// Not root, for whom permissions do not count.
class OrdinaryUser {
public:
    OrdinaryUser() : was_(geteuid()) {
        if (was_ == 0) ordinary = seteuid(65534) == 0;
    }
    ~OrdinaryUser() {
        if (geteuid() != was_ && seteuid(was_) != 0) std::abort();
    }
    bool ordinary = true;

private:
    uid_t was_;
};

} // namespace

TEST_CASE("a save that fails half way leaves the old file and nothing else") {
    const SavedScene saved;
    for (const rlim_t room : {0, 1, 1000, 2000}) {
        INFO(room << " bytes of room");
        const FileSizeLimit limit(room);
        CHECK_THROWS_WITH(saveScene(samples::brow(), saved.file),
                          Catch::StartsWith(saved.file + ": cannot be written"));
        CHECK(saved.isUntouched());
        CHECK_THROWS_AS(saveWithBuffer(layerOf(samples::everything()), saved.file), InputError);
    }
    CHECK(readWholeFile(saved.file) == saved.before);
    saveScene(samples::brow(), saved.file);
    CHECK(readWholeFile(saved.file) != saved.before);
}

TEST_CASE("a save without permission leaves the old file and nothing else") {
    const SavedScene saved;
    fs::permissions(saved.folder, fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read |
                                      fs::perms::others_exec);
    {
        const OrdinaryUser user;
        if (!user.ordinary) {
            WARN("skipped, root cannot become an ordinary user here");
            return;
        }
        CHECK_THROWS_WITH(saveScene(samples::brow(), saved.file), Catch::Contains("cannot be written"));
    }
    CHECK(saved.isUntouched());
}
