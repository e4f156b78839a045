#pragma once
#include "bake/scene/Layer.h"

#include <bit>
#include <cmath>
#include <random>

/// Random layers for property tests: every kind of value in every kind of slot, with nasty numbers and texts.
class RandomLayer {
public:
    explicit RandomLayer(std::uint64_t seed) : random_(seed) {}

    tss::Layer layer() {
        tss::Layer layer;
        layer.metadata = object(2);
        layer.other = object(1);
        layer.other.erase("format"); // a random key could be one of the layer's own
        layer.children = prims(3);
        return layer;
    }

private:
    std::size_t below(std::size_t n) { return n == 0 ? 0 : random_() % n; }

    double number() {
        static const double nasty[] = {0,
                                       -0.0,
                                       0.1,
                                       1e-320,
                                       1.7976931348623157e308,
                                       9007199254740993.0,
                                       -1e15,
                                       1e21,
                                       1.0 / 3,
                                       4503599627370497.5};
        if (below(3) == 0) return nasty[below(std::size(nasty))];
        const double bits = std::bit_cast<double>(random_());
        return std::isfinite(bits) ? bits : static_cast<double>(below(1000));
    }

    double realFor(bool single) {
        if (below(20) == 0) return below(2) ? INFINITY : -INFINITY;
        const auto bits = static_cast<std::uint32_t>(random_());
        const float small = std::bit_cast<float>(bits);
        if (single) return std::isfinite(small) ? small : -0.0f;
        return number();
    }

    std::string text() {
        static const char* const pieces[] = {"a", "\"", "\\", "\n", "\x01", "é", "漢", "🦷", "/", "~", " "};
        std::string text;
        for (std::size_t n = below(5); n > 0; --n) text += pieces[below(std::size(pieces))];
        return text;
    }

    std::string name(std::size_t k) { return std::string(1, char('a' + below(26))) + std::to_string(k); }

    tss::Value::Object object(int depth) {
        tss::Value::Object object;
        for (std::size_t n = below(4); n > 0; --n) object[std::string("k") + text()] = any(depth);
        return object;
    }

    tss::Value any(int depth) {
        switch (below(depth > 0 ? 8 : 6)) {
        case 0:
            return {};
        case 1:
            return tss::Value(below(2) == 0);
        case 2:
            return tss::Value(number());
        case 3:
            return tss::Value(text());
        case 4:
            return tss::Value(static_cast<std::uint64_t>(random_()));
        case 5:
            return tss::Value(-static_cast<std::int64_t>(random_() >> 1));
        case 6:
            return tss::Value(object(depth - 1));
        default:
            return array(depth - 1);
        }
    }

    /// An array in the one form that the parser has for it: text at its end keeps it from being a block of
    /// numbers.
    tss::Value array(int depth) {
        if (below(2)) return block(below(4), false);
        tss::Value::Array array;
        for (std::size_t n = below(4); n > 0; --n) array.push_back(any(depth));
        array.emplace_back(text());
        return tss::Value(std::move(array));
    }

    tss::Value block(int width, bool single) {
        tss::Numbers numbers{{}, width};
        for (std::size_t n = (1 + below(50)) * std::max(width, 1); n > 0; --n)
            numbers.values.push_back(single ? realFor(true) : number());
        return tss::Value(std::move(numbers));
    }

    tss::Property property() {
        tss::Property property;
        property.other = object(1);
        property.other.erase("default");
        switch (below(6)) {
        case 0:
            property.targetPaths =
                tss::Value(tss::Value::Array{tss::Value(std::string("/") + name(0)), tss::Value("/a/b.c")});
            break;
        case 1:
            property.typeName = "float3[]";
            property.defaultValue = block(3, true);
            break;
        case 2:
            property.typeName = "double";
            for (int k = 0; k < 5; ++k) property.timeSamples.push_back({k + 0.1, tss::Value(realFor(false))});
            if (below(2)) property.timeSamples.push_back({9, {}});
            break;
        case 3:
            property.typeName = "their:type";
            property.defaultValue = any(2);
            break;
        case 4:
            property.typeName = "float[]";
            property.defaultValue = block(0, true);
            break;
        default:
            property.typeName = "token";
            property.defaultValue = tss::Value(text());
        }
        return property;
    }

    std::vector<tss::Prim> prims(int depth) {
        std::vector<tss::Prim> prims;
        for (std::size_t n = below(4); n > 0; --n) {
            tss::Prim prim;
            prim.name = name(n);
            prim.typeName = below(2) ? "Xform" : "";
            prim.metadata = object(2);
            prim.other = object(1);
            for (std::size_t k = below(4); k > 0; --k) prim.properties[name(k) + ":" + name(k)] = property();
            if (depth > 0) prim.children = this->prims(depth - 1);
            prims.push_back(std::move(prim));
        }
        return prims;
    }

    std::mt19937_64 random_;
};
