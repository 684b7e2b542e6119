/* Vectors of three floats. */
#pragma once

#include <cmath>

namespace panels {

struct vec3 {
    float x = 0.0f, y = 0.0f, z = 0.0f;
};

inline vec3 operator+(vec3 a, vec3 b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline vec3 operator-(vec3 a, vec3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline vec3 operator*(float s, vec3 a) {
    return {s * a.x, s * a.y, s * a.z};
}
inline vec3 &operator+=(vec3 &a, vec3 b) {
    return a = a + b;
}
inline float dot(vec3 a, vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline float length(vec3 a) {
    return std::sqrt(dot(a, a));
}

} // namespace panels
