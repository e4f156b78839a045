#include "bake/report/Columns.h"
#include "bake/report/Report.h"

namespace tss::reporting {

namespace {

std::string cell(const Json& value) {
    if (value.is_null()) return "";
    if (!value.is_string()) return value.dump();
    std::string out = "\"";
    for (const char c : value.get<std::string>()) out += c == '"' ? "\"\"" : std::string(1, c);
    return out + "\"";
}

/// headings: of the file; what the rows know none of stays empty.
template <class R>
std::string lines(const std::string& path, const std::vector<std::string>& headings,
                  const Columns<R>& columns, const std::vector<R>& rows) {
    std::string text;
    for (const R& row : rows) {
        text += cell(path);
        for (const std::string& heading : headings) {
            text += ',';
            for (const Column<R>& column : columns)
                if (column.csv == heading) text += cell(column.value(row));
        }
        text += '\n';
    }
    return text;
}

} // namespace

std::string csvOf(const Report& report) {
    std::string text = "pair";
    std::vector<std::string> headings;
    for (const Column<Row>& column : methodColumns(PairStudy{}))
        if (!column.csv.empty()) {
            headings.push_back(column.csv);
            text += "," + column.csv;
        }
    text += "\n";
    for (const PairStudy& study : report.pairs)
        text += lines(study.path, headings, methodColumns(study), study.rows);
    for (const SkinStudy& study : report.skins)
        text += lines(study.path, headings, methodColumns(study), study.methods);
    return text;
}

} // namespace tss::reporting
