#include "bake/report/Study.h"

#include "bake/pipeline/BakeOptions.h"

namespace tss::reporting {

std::string unitOf(const Dof& dof, double metersPerUnit) {
    switch (dof.kind) {
    case DofKind::Rotation:
        return "degrees";
    case DofKind::Translation:
        return "times " + lengthText(dof.axis.norm(), metersPerUnit);
    case DofKind::Path:
        return "of its path";
    }
    return "";
}

std::vector<const Row*> paretoFront(const std::vector<Row>& rows, const std::function<double(const Row&)>& x,
                                    const std::function<double(const Row&)>& y) {
    std::vector<const Row*> sorted, front;
    for (const Row& row : rows)
        if (x(row) > 0 && !row.slow()) sorted.push_back(&row);
    std::ranges::stable_sort(sorted, [&](const Row* a, const Row* b) { return x(*a) < x(*b); });
    for (const Row* row : sorted)
        if (front.empty() || y(*row) < y(*front.back())) front.push_back(row);
    return front;
}

} // namespace tss::reporting
