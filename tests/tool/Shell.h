#pragma once
#include <filesystem>
#include <string>

/// What a program printed and how it ended.
struct Ran {
    int exit = -1;
    std::string out, err;
};

/// Runs `tss <arguments>` through the shell, in `folder`; `before`: a command that the shell runs before it.
Ran runTss(const std::string& arguments, const std::filesystem::path& folder,
           const std::string& before = ":");

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
