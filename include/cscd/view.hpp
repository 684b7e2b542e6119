/* Spans, and positions as C++ programs store them: arrays of floats or doubles, of points, of structs with a point
 * among their members, or by columns. Part of cscd/cscd.hpp, which says what holds for all. */
#ifndef CSCD_VIEW_HPP
#define CSCD_VIEW_HPP

#include <cscd/detector.h>
#include <cscd/error.hpp>

#include <array>
#include <cstddef>
#include <iterator>
#include <type_traits>
#include <utility>

namespace cscd {

/* Elements that lie one after the other, and belong to somebody else; as std::span of C++20, to which it converts. */
template <class T> class span {
  public:
    using element_type = T;
    using value_type = std::remove_cv_t<T>;
    using size_type = std::size_t;
    using iterator = T *;

    constexpr span() noexcept = default;
    constexpr span(T *data, std::size_t size) noexcept : data_(data), size_(size) {
    }
    template <class Container,
              class Element = std::remove_pointer_t<decltype(std::data(std::declval<Container &>()))>,
              class = std::enable_if_t<std::is_convertible_v<Element (*)[], T (*)[]>>>
    constexpr span(Container &&container) noexcept
        : data_(std::data(container)), size_(std::size(container)) {
    }

    constexpr T *data() const noexcept {
        return data_;
    }
    constexpr std::size_t size() const noexcept {
        return size_;
    }
    constexpr bool empty() const noexcept {
        return size_ == 0;
    }
    constexpr T *begin() const noexcept {
        return data_;
    }
    constexpr T *end() const noexcept {
        return data_ + size_;
    }
    constexpr T &operator[](std::size_t i) const noexcept {
        return data_[i];
    }

  private:
    T *data_ = nullptr;
    std::size_t size_ = 0;
};

/* ---- points ------------------------------------------------------------------------------------------- */

namespace detail {

/* The type of x, y and z, or a type with the name Scalar; else void. */
template <class Point, class X = decltype(std::declval<Point &>().x),
          class Y = decltype(std::declval<Point &>().y), class Z = decltype(std::declval<Point &>().z),
          class = std::enable_if_t<std::is_same_v<X, Y> && std::is_same_v<X, Z>>>
std::remove_cv_t<X> guess_scalar(int);
template <class Point> typename Point::Scalar guess_scalar(long);
template <class Point> void guess_scalar(...);

} // namespace detail

/* The type of a point's three coordinates, which lie one after the other at its beginning: float or double. Known
 * are arrays of three, structs that begin with x, y and z, and types with a Scalar, as those of Eigen. A program
 * may specialize it for points of its own. */
template <class Point> struct scalar_of { using type = decltype(detail::guess_scalar<Point>(0)); };
template <class Scalar> struct scalar_of<Scalar[3]> { using type = Scalar; };
template <class Scalar> struct scalar_of<std::array<Scalar, 3>> { using type = Scalar; };

namespace detail {

template <class Point> using scalar_type = typename scalar_of<std::remove_cv_t<Point>>::type;

template <class T>
constexpr bool is_scalar =
    std::is_same_v<std::remove_cv_t<T>, float> || std::is_same_v<std::remove_cv_t<T>, double>;

template <class T> constexpr bool is_point() {
    if constexpr (is_scalar<scalar_type<T>>)
        return sizeof(T) >= 3 * sizeof(scalar_type<T>);
    else
        return false;
}

template <class Scalar>
constexpr cscd_scalar scalar_kind = std::is_same_v<Scalar, float> ? CSCD_SCALAR_FLOAT : CSCD_SCALAR_DOUBLE;

/* What a container holds, const or not; void: it is no container. */
template <class T, class = void> struct element_type { using type = void; };
template <class T> struct element_type<T, std::void_t<decltype(std::data(std::declval<T &>()))>> {
    using type = std::remove_pointer_t<decltype(std::data(std::declval<T &>()))>;
};
template <class Container> using element_of = typename element_type<std::remove_reference_t<Container>>::type;

/* Matrices of Eigen, but not its vectors without gaps: whether their coordinates lie point by point is not for us to
 * guess. */
template <class T, class = void> constexpr bool is_matrix = false;
template <class T>
constexpr bool is_matrix<T, std::void_t<decltype(T::IsRowMajor)>> =
    T::IsVectorAtCompileTime == 0 || T::InnerStrideAtCompileTime != 1;

template <class Container>
constexpr bool holds_positions = (is_scalar<element_of<Container>> || is_point<element_of<Container>>()) &&
                                 !is_matrix<std::remove_cv_t<std::remove_reference_t<Container>>>;

} // namespace detail

/* ---- views -------------------------------------------------------------------------------------------- */

/* A view of what can be written to can be read, too. */
struct mutable_view : cscd_mutable_view {
    operator cscd_view() const noexcept {
        return {data, size, stride, coordinate_stride, scalar, object_count};
    }
};

namespace detail {

template <class Element>
using view_type = std::conditional_t<std::is_const_v<Element>, cscd_view, mutable_view>;

} // namespace detail

namespace detail {

/* A temporary that only refers to elements, as a span does, may go before its view; one that holds them may not. */
template <class T> constexpr bool holds_elements = !std::is_trivially_destructible_v<T>;
template <class T, std::size_t N> constexpr bool holds_elements<std::array<T, N>> = true;
template <class T, std::size_t N> constexpr bool holds_elements<T[N]> = true;

template <class Container> constexpr void expect_lasting() {
    static_assert(
        std::is_lvalue_reference_v<Container> ||
            !holds_elements<std::remove_cv_t<std::remove_reference_t<Container>>>,
        "view_of: the container is a temporary, which is gone before its view is used: give it a name");
}

/* Says why no view can be made of a container. */
template <class Container> constexpr void expect_positions() {
    static_assert(!is_matrix<std::remove_cv_t<std::remove_reference_t<Container>>>,
                  "cscd does not guess how a matrix lies: say view_of_columns, or give a span of its data");
    static_assert(
        is_matrix<std::remove_cv_t<std::remove_reference_t<Container>>> || holds_positions<Container>,
        "cscd does not know points of this type: specialize cscd::scalar_of for it, or name the member that is "
        "a point, by view_of(structs, &type::member)");
}

template <class Container>
constexpr bool is_other_container =
    !std::is_void_v<element_of<Container>> && !holds_positions<Container> &&
    !std::is_same_v<std::remove_cv_t<element_of<Container>>, cscd_view> &&
    !std::is_base_of_v<cscd_mutable_view, std::remove_cv_t<element_of<Container>>>;

} // namespace detail

/* A view of a container of points, or of packed floats or doubles x, y, z; one that can be written to, if the
 * container can. */
template <class Container, class = std::enable_if_t<!std::is_void_v<detail::element_of<Container>>>>
auto view_of(Container &&container) {
    detail::expect_lasting<Container>();
    detail::expect_positions<Container>();
    using element = detail::element_of<Container>;
    detail::view_type<element> view{};
    view.data = std::data(container);
    view.size = std::size(container) * sizeof(element);
    if constexpr (detail::is_scalar<element>) {
        view.scalar = detail::scalar_kind<std::remove_cv_t<element>>;
    } else {
        view.stride = sizeof(element);
        view.scalar = detail::scalar_kind<detail::scalar_type<element>>;
    }
    return view;
}

/* A view of a member of the structs in a container: view_of(particles, &particle::position). */
template <class Container, class Struct, class Point, class = std::enable_if_t<detail::is_point<Point>()>>
auto view_of(Container &&structs, Point Struct::*member) {
    detail::expect_lasting<Container>();
    using element = detail::element_of<Container>;
    using point = std::conditional_t<std::is_const_v<element>, const Point, Point>;
    detail::view_type<element> view{};
    std::size_t count = std::size(structs);
    if (count > 0) {
        point *first = &(std::data(structs)[0].*member);
        view.data = first;
        view.size = (count - 1) * sizeof(element) + sizeof(Point);
    }
    view.stride = sizeof(element);
    view.scalar = detail::scalar_kind<detail::scalar_type<Point>>;
    return view;
}

/* A view of a matrix whose three columns are x, y and z, one after the other. (A matrix whose points lie one after the
 * other is given as a span of its data.) */
template <class Container, class = std::enable_if_t<detail::is_scalar<detail::element_of<Container>>>>
auto view_of_columns(Container &&matrix) {
    detail::expect_lasting<Container>();
    using element = detail::element_of<Container>;
    detail::view_type<element> view{};
    view.data = std::data(matrix);
    view.size = std::size(matrix) * sizeof(element);
    view.stride = sizeof(element);
    view.coordinate_stride = view.size / 3;
    view.scalar = detail::scalar_kind<std::remove_cv_t<element>>;
    return view;
}

/* ---- arguments ---------------------------------------------------------------------------------------- */

namespace detail {

/* The views must hold all objects of the mesh, because C cannot know how many views there are. */
template <class View>
const View *covering_views(const View *views, std::size_t count, std::uint32_t objects) {
    std::uint64_t held = 0;
    for (std::size_t i = 0; i < count; i++) {
        if (views[i].object_count == 0) return views;
        held += views[i].object_count;
    }
    if (held >= objects) return views;
    throw error(CSCD_INVALID_ARGUMENT, "the views hold " + std::to_string(held) + " of the mesh's " +
                                           std::to_string(objects) + " objects");
}

/* One view, or several. */
template <class View> class views {
  public:
    const View *covering(std::uint32_t objects) const {
        return covering_views(several_ != nullptr ? several_ : &one_, count_, objects);
    }

  protected:
    explicit views(const View &one) : one_(one) {
    }
    explicit views(span<const View> several) : several_(several.data()), count_(several.size()) {
        if (several.empty()) throw error(CSCD_INVALID_ARGUMENT, "there is no view");
    }

  private:
    View one_{};
    const View *several_ = nullptr;
    std::size_t count_ = 1;
};

template <class Container, class View>
constexpr bool holds_views = std::is_same_v<std::remove_cv_t<element_of<Container>>, View>;

} // namespace detail

/* Positions that a function reads: a view, a container of views that hold the objects of the mesh in turn, or a
 * container of which view_of can make a view. It lives no longer than these; functions take it as an argument. */
class positions : public detail::views<cscd_view> {
  public:
    positions(const cscd_view &view) : views(view) {
    }
    positions(const cscd_mutable_view &view) : views(mutable_view{view}) {
    }
    template <class Container, std::enable_if_t<detail::holds_views<const Container, cscd_view>, int> = 0>
    positions(const Container &container) : views(span<const cscd_view>(container)) {
    }
    template <class Container, std::enable_if_t<detail::holds_positions<const Container>, int> = 0>
    positions(const Container &container) : views(view_of(container)) {
    }
    template <class Container, std::enable_if_t<detail::is_other_container<const Container>, long> = 0>
    positions(const Container &container) : views(view_of(container)) {
    }
};

/* Positions that a function writes, in the same forms. */
class mutable_positions : public detail::views<cscd_mutable_view> {
  public:
    mutable_positions(const cscd_mutable_view &view) : views(view) {
    }
    template <class Container, std::enable_if_t<detail::holds_views<Container, cscd_mutable_view>, int> = 0>
    mutable_positions(const Container &container) : views(span<const cscd_mutable_view>(container)) {
    }
    template <class Container, class Element = detail::element_of<Container>,
              std::enable_if_t<detail::holds_positions<Container> && !std::is_const_v<Element>, int> = 0>
    mutable_positions(Container &&container) : views(view_of(container)) {
    }
};

} // namespace cscd

#endif
