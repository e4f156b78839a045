#include "bake/table/PreparedTable.h"

#include "bake/table/TableKernels.h"

namespace tss {

const char* name(KernelForm form) {
    return form == KernelForm::Fold ? "fold" : "direct";
}
const char* name(KernelPrecision precision) {
    return precision == KernelPrecision::Float ? "float" : "double";
}

PreparedTable::PreparedTable(const Table& table, const PrepareOptions& options)
    : kernels_(std::make_unique<const TableKernels>(table, options)) {
    if (options.cells != CellUse::Never && table.motion.dofCount() <= VerdictGrid::mostDofs)
        verdicts_ = VerdictGrid(kernels_->motion(), tablePairs(table), kernels_->signBand());
}

PreparedTable::PreparedTable(PreparedTable&&) noexcept = default;
PreparedTable& PreparedTable::operator=(PreparedTable&&) noexcept = default;
PreparedTable::~PreparedTable() = default;

bool PreparedTable::hitAsked(const double* q) const {
    if (const Verdict known = verdicts_.within(q); known != Verdict::Ask) return known == Verdict::Touch;
    return kernels_->hit(q);
}

void PreparedTable::features(const double* q, TableFeatures& out) const {
    kernels_->features(q, out);
}

void PreparedTable::features(const std::array<double, 12>& pose, TableFeatures& out) const {
    kernels_->features(pose, out);
}

bool PreparedTable::hit(const TableFeatures& f) const {
    return kernels_->hit(f);
}

TableGap PreparedTable::gap(const double* q) const {
    TableFeatures f;
    features(q, f);
    return gap(f);
}

TableGap PreparedTable::gap(const TableFeatures& f) const {
    return kernels_->gap(f);
}

TableContact PreparedTable::contact(const double* q) const {
    TableFeatures f;
    MotionFrame at;
    TableContact found;
    features(q, f);
    frame(q, at);
    contact(f, at, found);
    return found;
}

void PreparedTable::contact(const TableFeatures& f, const MotionFrame& frame, TableContact& out) const {
    kernels_->contact(f, frame, out);
}

void PreparedTable::frame(const double* q, MotionFrame& out) const {
    kernels_->frame(q, out);
}

std::uint32_t PreparedTable::testsWithin(const TableFeatures& f, double margin, std::uint32_t* out) const {
    return kernels_->testsWithin(f, margin, out);
}

std::uint32_t PreparedTable::testsWithin(const double* q, double margin, std::uint32_t* out) const {
    if (verdicts_.clearance(q) > kernels_->reachOf(margin)) return 0;
    return kernels_->testsWithin(q, margin, out);
}

void PreparedTable::instanceFeatures(const double* q, std::uint32_t count, InstanceFeatures& out) const {
    kernels_->instanceFeatures(q, count, out);
}

void PreparedTable::hits(const InstanceFeatures& f, std::uint8_t* hit) const {
    kernels_->hits(f, hit);
}

std::size_t PreparedTable::testCount() const {
    return kernels_->testCount();
}

std::size_t PreparedTable::testRoom() const {
    return kernels_->testRoom();
}

std::size_t PreparedTable::dofCount() const {
    return kernels_->dofCount();
}

TablePair PreparedTable::pair(std::size_t test) const {
    return kernels_->test(test);
}

KernelForm PreparedTable::form() const {
    return kernels_->form();
}

KernelPrecision PreparedTable::precision() const {
    return kernels_->precision();
}

KernelTarget PreparedTable::target() const {
    return kernels_->target();
}

std::size_t PreparedTable::bytes() const {
    return kernels_->bytes() + verdicts_.bytes();
}

double PreparedTable::signBand() const {
    return kernels_->signBand();
}

double PreparedTable::gapBand() const {
    return kernels_->gapBand();
}

} // namespace tss
