/* The same program as client.c in C++17, with owners that destroy what they own. */
#include <cscd/cscd.h>

#include <array>
#include <cstdio>
#include <memory>
#include <stdexcept>

namespace {

template <auto destroy> struct destroyer {
    template <typename T> void operator()(T *object) const noexcept {
        destroy(object);
    }
};
using context_owner = std::unique_ptr<cscd_context, destroyer<cscd_context_destroy>>;
using mesh_owner = std::unique_ptr<cscd_mesh, destroyer<cscd_mesh_destroy>>;
using plan_owner = std::unique_ptr<cscd_plan, destroyer<cscd_plan_destroy>>;
using detector_owner = std::unique_ptr<cscd_detector, destroyer<cscd_detector_destroy>>;

constexpr std::array<uint32_t, 24> triangles{0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3,
                                             4, 6, 5, 4, 5, 7, 5, 6, 7, 6, 4, 7};
constexpr std::array<double, 24> start{0, 0, 0,  4, 0, 0,  0, 4, 0,  0, 0, 4,
                                       1, 1, -1, 2, 1, -2, 1, 2, -2, 1, 1, -3};

/* Takes over what the function create made. */
template <typename Owner, typename Create> Owner make(const cscd_context *context, Create create) {
    typename Owner::pointer object = nullptr;
    const cscd_status status = create(&object);
    if (status != CSCD_OK)
        throw std::runtime_error(context ? cscd_context_detail(context) : cscd_status_string(status));
    return Owner(object);
}

void print_contacts() {
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = 2;
    const auto context =
        make<context_owner>(nullptr, [&](auto out) { return cscd_context_create(&options, out); });
    const cscd_object_desc object = cscd_object_of_triangles(8, 8, triangles.data());
    const auto mesh = make<mesh_owner>(
        context.get(), [&](auto out) { return cscd_mesh_create(context.get(), &object, 1, out); });
    const cscd_view x0 = cscd_view_doubles(start.data(), 8);
    const auto plan = make<plan_owner>(context.get(), [&](auto out) {
        return cscd_plan_create(context.get(), mesh.get(), &x0, nullptr, out);
    });
    const auto detector = make<detector_owner>(context.get(), [&](auto out) {
        return cscd_detector_create(context.get(), mesh.get(), plan.get(), nullptr, out);
    });
    auto end = start;
    for (std::size_t z = 14; z < end.size(); z += 3) end[z] += 1.5;
    const cscd_view x1 = cscd_view_doubles(end.data(), 8);
    cscd_contacts contacts{};
    if (cscd_detector_step(detector.get(), &x0, &x1, &contacts) != CSCD_OK)
        throw std::runtime_error(cscd_context_detail(context.get()));
    for (std::size_t i = 0; i < contacts.count; i++) {
        const cscd_contact &contact = contacts.items[i];
        std::printf("%s %u %u at t = %.3f\n", cscd_contact_kind_name(contact.kind), contact.a, contact.b,
                    contact.toi);
    }
}

} // namespace

int main() {
    std::printf("cscd %s\n", cscd_version_string());
    try {
        print_contacts();
    } catch (const std::exception &failure) {
        std::fprintf(stderr, "%s\n", failure.what());
        return 1;
    }
    return 0;
}
