#pragma once
#include <string>
#include <string_view>

namespace tss::reporting {

/// index.html of a report, with REPORT_DATA where its data goes.
std::string_view pageTemplate();

struct Report;

/// The report as a page of its own: one file that fetches nothing, from the data of report.json and pictures
/// of the pairs.
std::string pageOf(const Report& report);

} // namespace tss::reporting
