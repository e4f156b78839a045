#include "CollectTriangles.h"

#include <osg/TriangleFunctor>
#include <osgTSS/Convert>

#include <map>

namespace osgTSS {

namespace {

struct Collector {
    const osg::Matrixd* matrix = nullptr;
    double scale = 1;
    bool mirrored = false;
    tss::TriangleMesh* mesh = nullptr;
    std::map<osg::Vec3, int> vertexAt;
    std::size_t dropped = 0;

    bool finite(const osg::Vec3& point) const {
        return point.valid() && toCore(osg::Vec3d(point) * *matrix).allFinite();
    }

    int vertex(const osg::Vec3& point) {
        const auto [entry, fresh] = vertexAt.emplace(point, static_cast<int>(mesh->vertices.size()));
        if (fresh) mesh->vertices.push_back(scale * toCore(osg::Vec3d(point) * *matrix));
        return entry->second;
    }

    void operator()(const osg::Vec3& a, const osg::Vec3& b, const osg::Vec3& c) {
        if (!finite(a) || !finite(b) || !finite(c)) {
            ++dropped;
            return;
        }
        const int i = vertex(a), j = vertex(b), k = vertex(c);
        if (i == j || j == k || k == i) return; // strips are stitched together with such
        mesh->triangles.push_back(mirrored ? tss::Tri(i, k, j) : tss::Tri(i, j, k));
    }
    // The signature of OSG before 3.5.
    void operator()(const osg::Vec3& a, const osg::Vec3& b, const osg::Vec3& c, bool) { (*this)(a, b, c); }
};

double determinant(const osg::Matrixd& m) {
    const osg::Vec3d x(m(0, 0), m(0, 1), m(0, 2)), y(m(1, 0), m(1, 1), m(1, 2)), z(m(2, 0), m(2, 1), m(2, 2));
    return (x ^ y) * z;
}

} // namespace

std::size_t collectTriangles(const osg::Drawable& drawable, const osg::Matrixd& matrix, double scale,
                             tss::TriangleMesh& mesh) {
    osg::TriangleFunctor<Collector> functor;
    functor.matrix = &matrix;
    functor.scale = scale;
    functor.mirrored = (determinant(matrix) < 0) != (scale < 0);
    functor.mesh = &mesh;
    drawable.accept(functor);
    return functor.dropped;
}

} // namespace osgTSS
