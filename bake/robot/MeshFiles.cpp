#include "bake/robot/MeshFiles.h"

#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"

#include <filesystem>

namespace tss {

namespace fs = std::filesystem;

namespace {

bool isFolder(const fs::path& path) {
    std::error_code none;
    return fs::is_directory(path, none);
}

fs::path realPath(const fs::path& path) {
    std::error_code error;
    const fs::path real = fs::weakly_canonical(path, error);
    return error ? path.lexically_normal() : real;
}

/// The name that a package.xml gives; empty where the folder has none.
std::string packageName(const fs::path& folder) {
    std::error_code none;
    const fs::path manifest = folder / "package.xml";
    if (!fs::is_regular_file(manifest, none) || fs::file_size(manifest, none) > (1 << 20)) return "";
    const std::string text = readWholeFile(manifest.string());
    const auto begin = text.find("<name>"), end = text.find("</name>");
    if (begin == text.npos || end == text.npos || end < begin + 6) return "";
    std::string name = text.substr(begin + 6, end - begin - 6);
    std::erase_if(name, [](unsigned char c) { return std::isspace(c); });
    return name;
}

/// A package beside or above the robot's file; empty where there is none.
fs::path packageAbove(const fs::path& robotFolder, const std::string& name) {
    for (fs::path folder = robotFolder;; folder = folder.parent_path()) {
        if (folder.filename() == name || packageName(folder) == name) return folder;
        if (isFolder(folder / name)) return folder / name;
        if (folder == folder.parent_path()) return {};
    }
}

/// The nearest folder at or above that has such a file; empty where none has.
fs::path folderWith(fs::path folder, const std::string& path) {
    std::error_code none;
    while (!fs::is_regular_file(folder / path, none) && folder != folder.parent_path())
        folder = folder.parent_path();
    return fs::is_regular_file(folder / path, none) ? folder : fs::path();
}

/// The folders that plain paths stay within: the package and the checkout of git that the robot is in.
std::vector<fs::path> homesOf(const fs::path& robotFolder) {
    std::error_code none;
    std::vector<fs::path> homes;
    for (const char* mark : {"package.xml", ".git"}) {
        fs::path folder = robotFolder;
        while (!fs::exists(folder / mark, none) && folder != folder.parent_path())
            folder = folder.parent_path();
        if (fs::exists(folder / mark, none)) homes.push_back(folder);
    }
    if (homes.empty()) homes.push_back(robotFolder.parent_path());
    return homes;
}

std::string found(const std::string& name, const fs::path& path, const std::vector<fs::path>& within,
                  const std::string& hint) {
    const fs::path real = realPath(path);
    std::error_code none;
    if (!fs::exists(real, none)) return real.string(); // which its reader says
    if (std::ranges::none_of(within,
                             [&](const fs::path& folder) { return isWithin(real, realPath(folder)); }))
        throw InputError("file \"" + name + "\" lies outside of " + within.front().string() +
                         "; expected it within" + hint);
    return real.string();
}

class Finder {
public:
    Finder(const std::string& file, const Packages& packages)
        : folder_(realPath(fs::absolute(file)).parent_path()), packages_(packages) {}

    std::string operator()(const std::string& name) const {
        if (name.empty() || name.find('\0') != name.npos) throw InputError("expected the name of a file");
        for (const char* scheme : {"package://", "model://"})
            if (name.starts_with(scheme)) return inPackage(name, name.substr(std::string(scheme).size()));
        const auto scheme = name.find("://");
        if (scheme != name.npos && !name.starts_with("file://"))
            throw InputError("file \"" + name +
                             "\": expected package://, model://, file:// or a path, and no other place");
        return besideFile(name, scheme == name.npos ? name : name.substr(7));
    }

private:
    std::string besideFile(const std::string& name, const std::string& path) const {
        std::vector<fs::path> within = homesOf(folder_);
        fs::path file = folder_ / path;
        std::error_code none;
        for (const fs::path& home : within)
            if (!fs::exists(file, none) && fs::exists(home / path, none)) file = home / path;
        for (const auto& [key, folder] : packages_)
            if (!folder.empty()) within.emplace_back(folder);
        fs::path both = folder_; // the nearest that holds the robot and the mesh
        while (both.has_relative_path() && !isWithin(realPath(file), both)) both = both.parent_path();
        return found(name, file, within,
                     ", or in the folder of a --package NAME=DIR" +
                         (both.has_relative_path() ? ", as --package all=" + both.string() : ""));
    }

    std::string inPackage(const std::string& name, const std::string& rest) const {
        const auto begin = std::min(rest.find_first_not_of('/'), rest.size()); // "package:///NAME/PATH" too
        const auto slash = rest.find('/', begin);
        const std::string package = rest.substr(begin, slash - begin);
        if (package.empty() || package == "." || package == "..")
            throw InputError("file \"" + name + "\": expected package://NAME/PATH");
        if (slash == rest.npos) return besideFile(name, package); // onshape-to-robot means that by it
        const auto given = packages_.find(package);
        if (given != packages_.end() && given->second.empty()) return "";
        const fs::path folder =
            given != packages_.end() ? fs::path(given->second) : packageAbove(folder_, package);
        if (folder.empty()) {
            const fs::path perhaps = folderWith(folder_, rest.substr(slash + 1));
            throw InputError("file \"" + name + "\": no folder of a package " + package + " at or above " +
                             folder_.string() + "; say where it is: --package " + package + "=" +
                             (perhaps.empty() ? "DIR" : perhaps.string() + " where such a file is") +
                             ", or leave its meshes out: --package " + package + "=");
        }
        return found(name, folder / rest.substr(slash + 1), {folder}, " its package");
    }

    fs::path folder_;
    Packages packages_;
};

} // namespace

Packages parsePackages(const std::vector<std::string>& texts) {
    Packages packages;
    for (const std::string& text : texts) {
        const auto sign = text.find('=');
        if (sign == text.npos || sign == 0)
            throw InputError("--package: expected NAME=DIR, found \"" + text + "\"");
        const std::string folder = text.substr(sign + 1);
        if (!folder.empty() && !isFolder(folder))
            throw InputError("--package " + text + ": there is no folder " + folder);
        packages[text.substr(0, sign)] = folder;
    }
    return packages;
}

FindMesh meshesOf(const std::string& file, const Packages& packages) {
    return Finder(file, packages);
}

} // namespace tss
