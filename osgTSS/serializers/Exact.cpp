#include "Exact.h"

#include <array>
#include <charconv>

std::string exactText(const std::vector<double>& values) {
    std::string text = std::to_string(values.size());
    std::array<char, 32> buffer;
    for (double value : values) {
        const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
        text += ' ';
        text.append(buffer.data(), end);
    }
    return text;
}

std::vector<double> exactValues(osgDB::InputStream& is, int count) {
    std::string text;
    is.readWrappedString(text);
    std::vector<double> values; // the count comes first
    const char* at = text.data();
    const char* const end = at + text.size();
    while (at != end) {
        double value = 0;
        const auto [next, error] = std::from_chars(at, end, value);
        if (error != std::errc()) break;
        values.push_back(value);
        at = next != end && *next == ' ' ? next + 1 : next;
    }
    const bool whole = at == end && !values.empty() && values[0] == static_cast<double>(values.size() - 1);
    if (whole && (count < 0 || values[0] == count)) {
        values.erase(values.begin());
        return values;
    }
    is.throwException("osgTSS: expected a count" +
                      (count < 0 ? std::string() : " of " + std::to_string(count)) +
                      " and as many numbers, found \"" + text + "\"");
    return std::vector<double>(count < 0 ? 0 : count);
}

void writeName(osgDB::OutputStream& os, const std::string& name) {
    os.writeWrappedString("=" + name);
}

std::string readName(osgDB::InputStream& is) {
    std::string text;
    is.readWrappedString(text);
    if (text.empty() || text[0] != '=') {
        is.throwException("osgTSS: expected a name after \"=\", found \"" + text + "\"");
        return {};
    }
    return text.substr(1);
}
