#pragma once
#include <filesystem>
#include <string>
#include <vector>

/// What a program printed and how it ended.
struct Ran {
    int exit = -1;
    std::string out, err;
};

/// Runs `tss <arguments>` through the shell, in `folder`; `before`: a command that the shell runs before it.
Ran runTss(const std::string& arguments, const std::filesystem::path& folder,
           const std::string& before = ":");

/// Runs the lines "    tss ..." of a page of docs/ one after the other in a folder that has examples/arm as
/// `arm`, and requires that each succeeds. Returns what they printed, one each.
std::vector<Ran> runPage(const std::string& page, const std::filesystem::path& folder);

/// A new empty folder that is removed with the object, unless TSS_TEST_KEEP is set in the environment.
class Folder {
public:
    Folder();
    ~Folder();
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    const std::filesystem::path& path() const { return path_; }
    std::string operator/(const std::string& name) const { return (path_ / name).string(); }

private:
    std::filesystem::path path_;
};

std::string readText(const std::filesystem::path& file);
void writeText(const std::filesystem::path& file, const std::string& text);

/// Number of entries in a folder.
std::size_t fileCount(const std::filesystem::path& folder);
