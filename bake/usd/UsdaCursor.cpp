#include "bake/usd/UsdaCursor.h"

#include <algorithm>
#include <charconv>
#include <limits>

namespace tss {

namespace {

bool isLetter(char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' ||
           static_cast<unsigned char>(c) > 127;
}
bool isDigit(char c) {
    return c >= '0' && c <= '9';
}

int hexDigit(char c) {
    if (isDigit(c)) return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

} // namespace

std::size_t UsdaCursor::line() const {
    const std::size_t to = std::min(at_, text_.size());
    if (to < countedTo_) countedTo_ = 0, counted_ = 1;
    counted_ += std::count(text_.begin() + countedTo_, text_.begin() + to, '\n');
    countedTo_ = to;
    return counted_;
}

void UsdaCursor::refuse(const std::string& message) const {
    throw InputError(Where{file_, "line " + std::to_string(line()), path_}, message);
}

void UsdaCursor::refuseFound(const std::string& wanted) {
    skip();
    std::string found;
    for (char c : text_.substr(std::min(at_, text_.size()), 20)) {
        if (static_cast<unsigned char>(c) < 0x20) break;
        found += c;
    }
    refuse("expected " + wanted + ", found " + (at_ >= text_.size() ? "the end" : "\"" + found + "\""));
}

void UsdaCursor::spend(std::size_t bytes) {
    if (bytes > budget_.memory) refuse("expected less: the files would take too much memory");
    budget_.memory -= bytes;
}

void UsdaCursor::skip() {
    while (at_ < text_.size()) {
        const char c = text_[at_];
        const std::string_view rest = text_.substr(at_, 2);
        if (c == ' ' || c == '\t' || c == '\n' || c == '\r') {
            ++at_;
        } else if (c == '#' || rest == "//") {
            at_ = std::min(text_.find('\n', at_), text_.size());
        } else if (rest == "/*") {
            const auto end = text_.find("*/", at_ + 2);
            if (end == text_.npos) refuse("expected the end of the comment, */");
            at_ = end + 2;
        } else {
            return;
        }
    }
}

char UsdaCursor::peek() {
    skip();
    return here();
}

bool UsdaCursor::take(char c) {
    if (peek() != c || at_ >= text_.size()) return false;
    ++at_;
    return true;
}

void UsdaCursor::expect(char c) {
    if (!take(c)) refuseFound(std::string("\"") + c + "\"");
}

std::string_view UsdaCursor::peekWord(bool colons) {
    skip();
    std::size_t end = at_;
    while (end < text_.size() && (isLetter(text_[end]) || (end > at_ && isDigit(text_[end])) ||
                                  (colons && end > at_ && text_[end] == ':')))
        ++end;
    while (end > at_ && text_[end - 1] == ':') --end;
    return text_.substr(at_, end - at_);
}

bool UsdaCursor::atWord() {
    return isLetter(peek());
}

bool UsdaCursor::takeWord(std::string_view word) {
    if (peekWord(true) != word) return false;
    at_ += word.size();
    return true;
}

std::string UsdaCursor::word(const char* wanted, bool colons) {
    const std::string_view found = peekWord(colons);
    if (found.empty()) refuseFound(wanted);
    at_ += found.size();
    return std::string(found);
}

bool UsdaCursor::atString() {
    return peek() == '"' || here() == '\'';
}

void UsdaCursor::escape(std::string& out) {
    const char c = here();
    ++at_;
    static constexpr std::string_view names = "abfnrtv", values = "\a\b\f\n\r\t\v";
    if (const auto known = names.find(c); known != names.npos) {
        out += values[known];
    } else if (c == 'x') {
        int value = 0, digits = 0;
        for (; digits < 2 && hexDigit(here()) >= 0; ++digits, ++at_) value = 16 * value + hexDigit(here());
        out += digits > 0 ? static_cast<char>(value) : 'x';
    } else if (c >= '0' && c <= '7') {
        int value = c - '0';
        for (int k = 0; k < 2 && here() >= '0' && here() <= '7'; ++k, ++at_) value = 8 * value + here() - '0';
        out += static_cast<char>(value);
    } else {
        out += c;
    }
}

std::string UsdaCursor::string(const char* wanted) {
    if (!atString()) refuseFound(wanted);
    const char quote = here();
    const std::string three(3, quote);
    const bool isLong = text_.substr(at_, 3) == three;
    const std::string end = isLong ? three : three.substr(0, 1);
    at_ += end.size();
    std::string out;
    while (text_.substr(std::min(at_, text_.size()), end.size()) != end) {
        if (at_ >= text_.size() || (!isLong && here() == '\n'))
            refuse("expected the end of the text, " + end);
        const char c = here();
        ++at_;
        if (c == '\\' && at_ < text_.size())
            escape(out);
        else
            out += c;
    }
    at_ += end.size();
    spend(out.size());
    return out;
}

std::string UsdaCursor::asset() {
    if (peek() != '@') refuseFound("the path of a file between @");
    const bool isLong = text_.substr(at_, 3) == "@@@";
    const std::string_view quote = isLong ? "@@@" : "@";
    const auto begin = at_ + quote.size();
    auto end = text_.find(quote, begin);
    if (end == text_.npos) refuse("expected the end of the path, " + std::string(quote));
    while (isLong && text_.substr(end + 3, 1) == "@") ++end; // of a path that ends so
    at_ = end + quote.size();
    std::string out(text_.substr(begin, end - begin));
    if (out.find('\n') != out.npos) refuse("expected the path of a file on one line");
    spend(out.size());
    return out;
}

std::string UsdaCursor::path() {
    expect('<');
    const auto end = text_.find('>', at_);
    if (end == text_.npos) refuse("expected the end of the path, >");
    std::string out(text_.substr(at_, end - at_));
    if (out.find('\n') != out.npos) refuse("expected a path on one line");
    at_ = end + 1;
    spend(out.size());
    return out;
}

std::string UsdaCursor::absolutePath() {
    const std::string path = this->path();
    if (path.find('{') != path.npos) refuse("paths into variants are not read, found <" + path + ">");
    if (path.empty() || path[0] == '/') return path;
    std::string at = path_;
    at = at.substr(0, at.find('.'));
    std::string_view rest = path;
    while (rest == ".." || rest.starts_with("../")) {
        if (at.empty()) refuse("expected a path within the layer, found <" + path + ">");
        at.resize(at.rfind('/'));
        rest.remove_prefix(std::min<std::size_t>(3, rest.size()));
    }
    if (rest.starts_with("./")) rest.remove_prefix(2);
    if (rest.empty() || rest == ".") return at;
    return at + (rest[0] == '.' ? "" : "/") + std::string(rest);
}

std::string_view UsdaCursor::numberText() {
    skip();
    std::size_t end = at_;
    if (end < text_.size() && (text_[end] == '-' || text_[end] == '+')) ++end;
    if (text_.substr(end, 3) == "inf" || text_.substr(end, 3) == "nan")
        end += 3;
    else
        while (
            end < text_.size() &&
            (isDigit(text_[end]) || text_[end] == '.' || text_[end] == 'e' || text_[end] == 'E' ||
             ((text_[end] == '-' || text_[end] == '+') && (text_[end - 1] == 'e' || text_[end - 1] == 'E'))))
            ++end;
    if (end < text_.size() && isLetter(text_[end])) return {};
    return text_.substr(at_, end - at_);
}

bool UsdaCursor::number(double& value) {
    const std::string_view text = numberText();
    if (text.empty() || isLetter(text[0])) {
        if (text != "inf" && text != "nan") return false;
    }
    const char* begin = text.data() + (text[0] == '+');
    const char* const end = text.data() + text.size();
    const auto result = std::from_chars(begin, end, value);
    if (result.ec == std::errc::result_out_of_range) // as OpenUSD: beyond all numbers, or next to none
        value = text.find("e-") != text.npos || text.find("E-") != text.npos
                    ? 0
                    : (text[0] == '-' ? -1 : 1) * std::numeric_limits<double>::infinity();
    else if (result.ec != std::errc() || result.ptr != end)
        return false;
    at_ += text.size();
    return true;
}

bool UsdaCursor::integer(std::string_view& digits) {
    const std::string_view text = numberText();
    const std::string_view bare = text.substr(!text.empty() && (text[0] == '-' || text[0] == '+'));
    if (bare.empty() || !std::ranges::all_of(bare, isDigit)) return false;
    digits = text;
    at_ += text.size();
    return true;
}

} // namespace tss
