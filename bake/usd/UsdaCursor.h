#pragma once
#include "bake/base/Error.h"

#include <string>
#include <string_view>

namespace tss {

/// What all layers of one stage may take together, in text and in memory. Spent while they are read.
struct UsdBudget {
    std::size_t text = std::size_t(128) << 20;   ///< bytes of files
    std::size_t memory = std::size_t(256) << 20; ///< bytes of what is made of them
};

/// A place in the text of a layer, and the words there. Blanks, line breaks and comments (#, //, /* */) are
/// skipped before each. Refuses with an InputError of the file, the line, and the prim that is open.
class UsdaCursor {
public:
    UsdaCursor(std::string_view text, std::string file, UsdBudget& budget)
        : text_(text), file_(std::move(file)), budget_(budget) {}

    [[noreturn]] void refuse(const std::string& message) const;
    /// "expected WANTED, found ..." as it stands there.
    [[noreturn]] void refuseFound(const std::string& wanted);
    void spend(std::size_t bytes);

    /// The character that comes next, NUL at the end.
    char peek();
    /// As peek(), but where the text goes on at once: nothing is skipped.
    char here() const { return at_ < text_.size() ? text_[at_] : '\0'; }
    /// Takes the character where it comes next.
    bool take(char c);
    void expect(char c);
    bool isNext(std::string_view word) { return peekWord(true) == word; }
    /// Takes the word where it comes next as a whole one.
    bool takeWord(std::string_view word);
    /// [A-Za-z_][A-Za-z0-9_]* with bytes beyond ASCII, and with `:` and `::` inside where wanted.
    std::string word(const char* wanted, bool colons = false);
    bool atWord();

    bool atString();
    std::string string(const char* wanted);
    /// What stands between @ and @, or @@@ and @@@.
    std::string asset();
    /// What stands between < and >.
    std::string path();
    /// The same, as it is seen from the open prim.
    std::string absolutePath();
    /// A number, or inf, -inf, nan; false with nothing taken where there is none.
    bool number(double& value);
    /// Digits alone, with their sign; false with nothing taken where a number has more than these.
    bool integer(std::string_view& digits);

    std::size_t line() const;
    void setPath(std::string path) { path_ = std::move(path); }
    const std::string& openPath() const { return path_; }
    const std::string& file() const { return file_; }

private:
    void skip();
    std::string_view peekWord(bool colons);
    std::string_view numberText();
    void escape(std::string& out);

    std::string_view text_;
    std::string file_, path_;
    std::size_t at_ = 0;
    mutable std::size_t countedTo_ = 0, counted_ = 1; ///< lines
    UsdBudget& budget_;
};

} // namespace tss
