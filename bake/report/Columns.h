#pragma once
#include "bake/report/SkinStudy.h"

#include <fmt/format.h>
#include <functional>
#include <nlohmann/json.hpp>

namespace tss::reporting {

using Json = nlohmann::ordered_json;

/// One figure of a row, for all that a report writes: report.json, report.csv, report.md and the page.
template <class Row>
struct Column {
    std::string json;  ///< place in the row's object of report.json, parts parted by '/'; empty: not there
    std::string csv;   ///< heading in report.csv; empty: not there
    std::string title; ///< heading in report.md and on the page, with its unit; empty: not there
    std::function<Json(const Row&)> value;         ///< null: not known
    std::function<std::string(const Row&)> text{}; ///< as it is read; none: the value, three digits
};
template <class Row>
using Columns = std::vector<Column<Row>>;

/// Lengths are millimetres, times nanoseconds, in all of them.
Columns<Row> methodColumns(const PairStudy& study);
Columns<BakePoint> modelColumns(const PairStudy& study);
Columns<SamplingPoint> samplingColumns();
Columns<SkinMethod> methodColumns(const SkinStudy& study);
Columns<SkinAnswer> answerColumns(const SkinStudy& study);

/// All models of a study, the base once.
std::vector<BakePoint> modelsOf(const PairStudy& study);
std::function<bool(const BakePoint&)> isBase(const PairStudy& study);

/// Which rows are told from others.
template <class Row>
using Own = std::type_identity_t<std::function<bool(const Row&)>>;

std::string textOf(const Json& value);

template <class Row>
std::string textOf(const Column<Row>& column, const Row& row) {
    return column.text ? column.text(row) : textOf(column.value(row));
}

/// The row's object of report.json.
template <class Row>
Json jsonOf(const Columns<Row>& columns, const Row& row) {
    Json json;
    for (const Column<Row>& column : columns)
        if (!column.json.empty()) json[Json::json_pointer("/" + column.json)] = column.value(row);
    return json;
}
template <class Row>
Json jsonOf(const Columns<Row>& columns, const std::vector<Row>& rows) {
    Json list = Json::array();
    for (const Row& row : rows) list.push_back(jsonOf(columns, row));
    return list;
}

/// A table of report.md; own: rows set in bold.
template <class Row>
std::string markdownTable(const Columns<Row>& columns, const std::vector<Row>& rows,
                          const Own<Row>& own = {}) {
    std::string head = "|", rule = "|", body;
    for (const Column<Row>& column : columns)
        if (!column.title.empty()) {
            head += " " + column.title + " |";
            rule += "---|";
        }
    for (const Row& row : rows) {
        std::string line = "|";
        const char* mark = own && own(row) ? "**" : "";
        for (const Column<Row>& column : columns)
            if (!column.title.empty()) {
                line += fmt::format(" {0}{1}{0} |", mark, textOf(column, row));
                mark = "";
            }
        body += line + "\n";
    }
    return head + "\n" + rule + "\n" + body;
}

/// A table of the page: {titles, rows: {cells: [{value, text}], own}}.
template <class Row>
Json pageTable(const Columns<Row>& columns, const std::vector<Row>& rows, const Own<Row>& own = {}) {
    Json table{{"titles", Json::array()}, {"rows", Json::array()}};
    for (const Column<Row>& column : columns)
        if (!column.title.empty()) table["titles"].push_back(column.title);
    for (const Row& row : rows) {
        Json cells = Json::array();
        for (const Column<Row>& column : columns)
            if (!column.title.empty())
                cells.push_back({{"value", column.value(row)}, {"text", textOf(column, row)}});
        table["rows"].push_back({{"cells", cells}, {"own", own && own(row)}});
    }
    return table;
}

} // namespace tss::reporting
