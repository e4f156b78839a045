#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
} // namespace CLI

namespace tss::cli {

// What the programs need of CLI11, by the names that it has there. CommandLine.cpp alone compiles it: it
// costs every object that sees it seconds.

/// One option of a command.
class Option {
public:
    explicit Option(CLI::Option& option) : option_(option) {}

    Option* required();
    Option* needs(Option* other);
    Option* excludes(Option* other);
    Option* allow_extra_args(bool allow);
    Option* expected(int least, int most); ///< most < 0: any number
    Option* delimiter(char between);
    Option* capture_default_str();
    Option* among(const std::vector<std::string>& choices);
    Option* between(int least, int most);
    Option* positive();

private:
    CLI::Option& option_;
};

/// A command, or the program.
class Options {
public:
    explicit Options(CLI::App& app) : app_(app) {}
    Options(const Options&) = delete;

    Options* add_subcommand(const std::string& name, const std::string& description);
    /// Value: a text, several, an int, a double or a std::uint64_t.
    template <class Value>
    Option* add_option(const std::string& name, Value& value, const std::string& description);
    /// Hears of the text that is given.
    Option* add_option(const std::string& name, const std::function<void(const std::string&)>& given,
                       const std::string& description);
    Option* add_flag(const std::string& name, bool& value, const std::string& description);
    Option* get_option(const std::string& name);
    std::vector<std::string> given() const; ///< names of the options that are on the line
    void footer(const std::string& text);
    void callback(std::function<void()> run);

private:
    Option* keep(CLI::Option* option);

    CLI::App& app_;
    std::deque<Option> options_;
    std::deque<Options> commands_;
};

/// Ends parse() as usage does: this option is missing. From a callback.
[[noreturn]] void failRequired(const std::string& option);
/// The same: this option cannot be used so.
[[noreturn]] void failUsage(const std::string& option, const std::string& why);

/// The program.
class CommandLine {
public:
    CommandLine(const std::string& name, const std::string& description, const std::string& version);
    ~CommandLine();

    Options& options() { return *options_; }
    /// Runs the callback of what is asked for: where there are commands, one of them has to be. Returns 2 for
    /// what is no usage, having said so; what the command throws is thrown.
    int parse(int argc, char** argv);

private:
    bool mistyped(const std::string& word) const;

    std::unique_ptr<CLI::App> app_;
    std::unique_ptr<Options> options_;
};

} // namespace tss::cli
