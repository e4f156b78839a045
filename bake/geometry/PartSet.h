#pragma once
#include "bake/geometry/SurfacePart.h"

#include <unordered_set>
#include <vector>

namespace tss {

/// A set of parts of one mesh's surface. Parts may be put in twice and inside one another.
class PartSet {
public:
    bool empty() const { return parts_.empty(); }

    void insert(SurfacePart part);

    /// The part itself or an ancestor of it (what it was halved from) is in the set.
    bool contains(SurfacePart part) const;

    /// As contains(), for a part no ancestor of which is in the set: one look-up.
    bool holds(SurfacePart part) const;

    /// The part itself or a descendant of it is in the set.
    bool reaches(SurfacePart part) const;

    /// The same surface in as few parts as there are: two halves become the whole; sorted.
    std::vector<SurfacePart> merged() const;

private:
    /// Keys of the parts. A part and a descendant of it may both be in it, but never both halves of one part.
    std::unordered_set<std::uint64_t> parts_;
    /// Keys of all parts that were ever inserted, and of all their ancestors.
    std::unordered_set<std::uint64_t> ancestors_;
};

/// The two halves of a part, in the order of halves(). Its cuts must be fewer than mostCuts.
std::array<SurfacePart, 2> halves(SurfacePart part);

/// The same parts of another mesh that has the triangles of this one among its own, at the same places: of
/// all that are there, should one be there more than once. Sorted.
std::vector<SurfacePart> partsOf(const TriangleMesh& other, const TriangleMesh& mesh,
                                 const std::vector<SurfacePart>& parts);

/// The parts as a mesh of their own, three vertices a part.
TriangleMesh meshOf(const TriangleMesh& mesh, const std::vector<SurfacePart>& parts);

/// Area of the parts; of the whole mesh.
double area(const TriangleMesh& mesh, const std::vector<SurfacePart>& parts);
double area(const TriangleMesh& mesh);

} // namespace tss
