/* A recording of what moves: an OBJ with a group for each object, and its frames as PC2. */
#pragma once

#include "tests/engine/safe_bodies.hpp"

#include <cstdio>
#include <cstring>
#include <string>

class frame_files {
  public:
    frame_files(const std::string &path, const safe_bodies &bodies, unsigned frame_count)
        : mesh_(bodies.mesh->get()), frames_(std::fopen((path + ".pc2").c_str(), "wb")) {
        write_mesh(path + ".obj", bodies.from);
        char header[32] = "POINTCACHE2";
        const std::int32_t version = 1, points = static_cast<std::int32_t>(cscd_mesh_vertex_count(mesh_)),
                           samples = static_cast<std::int32_t>(frame_count);
        const float begin = 0.0f, rate = 1.0f;
        std::memcpy(header + 12, &version, 4);
        std::memcpy(header + 16, &points, 4);
        std::memcpy(header + 20, &begin, 4);
        std::memcpy(header + 24, &rate, 4);
        std::memcpy(header + 28, &samples, 4);
        if (frames_ != nullptr) std::fwrite(header, 1, sizeof header, frames_);
    }
    frame_files(const frame_files &) = delete;
    frame_files &operator=(const frame_files &) = delete;
    ~frame_files() {
        if (frames_ != nullptr) std::fclose(frames_);
    }

    void add(const std::vector<cscd_view> &views) {
        for (std::uint32_t o = 0; frames_ != nullptr && o < views.size(); o++)
            for (std::uint32_t v = 0; v < cscd_mesh_object(mesh_, o).vertex_count; v++)
                std::fwrite(point_at(views[o], v), sizeof(float), 3, frames_);
    }

  private:
    static const float *point_at(const cscd_view &view, std::uint32_t vertex) {
        return reinterpret_cast<const float *>(static_cast<const unsigned char *>(view.data) +
                                               vertex * view.stride);
    }

    void write_mesh(const std::string &path, const std::vector<cscd_view> &views) const {
        std::FILE *file = std::fopen(path.c_str(), "w");
        if (file == nullptr) return;
        for (std::uint32_t o = 0; o < views.size(); o++) {
            for (std::uint32_t v = 0; v < cscd_mesh_object(mesh_, o).vertex_count; v++) {
                const float *p = point_at(views[o], v);
                std::fprintf(file, "v %.9g %.9g %.9g\n", double(p[0]), double(p[1]), double(p[2]));
            }
        }
        for (std::uint32_t t = 0, object = UINT32_MAX; t < cscd_mesh_triangle_count(mesh_); t++) {
            std::uint32_t corners[3];
            cscd_mesh_triangle(mesh_, t, corners);
            const std::uint32_t own = cscd_mesh_vertex_object(mesh_, corners[0]);
            if (own != object) std::fprintf(file, "g object%u\n", object = own);
            std::fprintf(file, "f %u %u %u\n", corners[0] + 1, corners[1] + 1, corners[2] + 1);
        }
        std::fclose(file);
    }

    const cscd_mesh *mesh_;
    std::FILE *frames_;
};
