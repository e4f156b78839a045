#include "bake/cli/CommandLine.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdlib>

namespace tss::cli {

Option* Option::required() {
    option_.required();
    return this;
}
Option* Option::needs(Option* other) {
    option_.needs(&other->option_);
    return this;
}
Option* Option::excludes(Option* other) {
    option_.excludes(&other->option_);
    return this;
}
Option* Option::allow_extra_args(bool allow) {
    option_.allow_extra_args(allow);
    return this;
}
Option* Option::expected(int least, int most) {
    option_.expected(least, most);
    return this;
}
Option* Option::delimiter(char between) {
    option_.delimiter(between);
    return this;
}
Option* Option::capture_default_str() {
    option_.capture_default_str();
    return this;
}
Option* Option::among(const std::vector<std::string>& choices) {
    option_.check(CLI::IsMember(choices));
    return this;
}
Option* Option::between(int least, int most) {
    option_.check(CLI::Range(least, most));
    return this;
}
Option* Option::positive() {
    // CLI::PositiveNumber would name the largest double as what may be.
    option_.check(
        [](const std::string& text) {
            return std::strtod(text.c_str(), nullptr) > 0 ? std::string()
                                                          : "expected more than 0, found " + text;
        },
        "POSITIVE");
    return this;
}

Options* Options::add_subcommand(const std::string& name, const std::string& description) {
    return &commands_.emplace_back(*app_.add_subcommand(name, description));
}
template <class Value>
Option* Options::add_option(const std::string& name, Value& value, const std::string& description) {
    return keep(app_.add_option(name, value, description));
}
template Option* Options::add_option(const std::string&, std::string&, const std::string&);
template Option* Options::add_option(const std::string&, std::vector<std::string>&, const std::string&);
template Option* Options::add_option(const std::string&, int&, const std::string&);
template Option* Options::add_option(const std::string&, double&, const std::string&);
template Option* Options::add_option(const std::string&, std::uint64_t&, const std::string&);
Option* Options::add_option(const std::string& name, const std::function<void(const std::string&)>& given,
                            const std::string& description) {
    return keep(app_.add_option_function<std::string>(name, given, description));
}
Option* Options::add_flag(const std::string& name, bool& value, const std::string& description) {
    return keep(app_.add_flag(name, value, description));
}
Option* Options::get_option(const std::string& name) {
    return keep(app_.get_option(name));
}

std::vector<std::string> Options::given() const {
    std::vector<std::string> names;
    for (const CLI::Option* option : app_.get_options())
        if (option->count() > 0) names.push_back(option->get_name());
    return names;
}
void Options::footer(const std::string& text) {
    app_.footer(text);
}
void Options::callback(std::function<void()> run) {
    app_.callback(std::move(run));
}
Option* Options::keep(CLI::Option* option) {
    return &options_.emplace_back(*option);
}

void failRequired(const std::string& option) {
    throw CLI::RequiredError(option);
}

void failUsage(const std::string& option, const std::string& why) {
    throw CLI::ValidationError(option, why);
}

CommandLine::CommandLine(const std::string& name, const std::string& description, const std::string& version)
    : app_(std::make_unique<CLI::App>(description, name)), options_(std::make_unique<Options>(*app_)) {
    app_->set_version_flag("--version", version);
}

CommandLine::~CommandLine() = default;

int CommandLine::parse(int argc, char** argv) {
    if (!app_->get_subcommands([](const CLI::App*) { return true; }).empty()) app_->require_subcommand(1);
    if (argc > 1 && mistyped(argv[1])) return 2;
    try {
        app_->parse(argc, argv);
        return 0;
    } catch (const CLI::ParseError& error) {
        return app_->exit(error) == 0 ? 0 : 2;
    }
}

/// A word that is no command; said here, as it would else be called a missing one.
bool CommandLine::mistyped(const std::string& word) const {
    const auto commands = app_->get_subcommands([](const CLI::App*) { return true; });
    const auto named = [&](const CLI::App* command) { return command->get_name() == word; };
    if (commands.empty() || word.starts_with('-') || std::ranges::any_of(commands, named)) return false;
    std::string names;
    for (const CLI::App* command : commands) names += " " + command->get_name();
    std::fprintf(stderr, "%s: \"%s\" is no command; expected one of%s\n", app_->get_name().c_str(),
                 word.c_str(), names.c_str());
    return true;
}

} // namespace tss::cli
