/* What the method's innermost kernels cost in C: the cubic of core/solver and Newton's step of core/patches/walk.py,
 * on the same arrays, component after component. Compiled and timed by tools/c_limit.py. */
#include <math.h>
#include <stddef.h>

#define TINY 1e-300
#define HUGE 1e100
#define SQRT3 1.7320508075688772
#define BLOCK 1024 /* pairs: what they take fits the cache */

typedef struct { double x, y, z; } vec;

static inline vec at(const double *a, size_t n, size_t i) { return (vec){a[i], a[n + i], a[2 * n + i]}; }
static inline vec add(vec a, vec b) { return (vec){a.x + b.x, a.y + b.y, a.z + b.z}; }
static inline vec sub(vec a, vec b) { return (vec){a.x - b.x, a.y - b.y, a.z - b.z}; }
static inline vec times(double t, vec a) { return (vec){t * a.x, t * a.y, t * a.z}; }
static inline double dot(vec a, vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline vec cross(vec a, vec b) {
    return (vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* c0 to c3 (4, m) of n places p, a, b and velocities (3, 3, m): cubic.coefficients. */
static inline void spread(size_t n, size_t m, const double *still, const double *moving, double *c) {
    for (size_t i = 0; i < n; i++) {
        vec p = at(still, m, i), a = at(still + 3 * m, m, i), b = at(still + 6 * m, m, i);
        vec r = at(moving, m, i), u = at(moving + 3 * m, m, i), v = at(moving + 6 * m, m, i);
        vec n0 = cross(a, b), n1 = add(cross(a, v), cross(u, b)), n2 = cross(u, v);
        c[i] = dot(p, n0);
        c[m + i] = dot(p, n1) + dot(r, n0);
        c[2 * m + i] = dot(p, n2) + dot(r, n1);
        c[3 * m + i] = dot(r, n2);
    }
}

void coefficients(size_t n, const double *still, const double *moving, double *c) { spread(n, n, still, moving, c); }

/* Real roots of cubics c (4, n), of which the first counts where there is but one, by the closed form and a step of
 * Newton's; without a branch, so that compilers with vector forms of cbrt and the like use them. */
static void roots(size_t n, const double *restrict c, double *restrict found) {
    for (size_t i = 0; i < n; i++) {
        double c0 = c[i], c1 = c[BLOCK + i], c2 = c[2 * BLOCK + i], c3 = c[3 * BLOCK + i];
        double third = c2 / (3.0 * c3), q = third * third - c1 / (3.0 * c3);
        double r = third * (q - 0.5 * c1 / (3.0 * c3)) + 0.5 * c0 / c3, discriminant = q * q * q - r * r;
        double size = sqrt(fabs(q)), ratio = r / (size * fabs(q));
        double angle = acos(fmin(fmax(ratio, -1.0), 1.0)) / 3.0;
        /* no call of the sine: compilers would join it to the cosine's, and the joint one has no vector form */
        double turn = cos(angle), cosine = size * turn, sine = SQRT3 * size * sqrt((1.0 - turn) * (1.0 + turn));
        double y = cbrt(fabs(r) + sqrt(fabs(discriminant))), alone = -copysign(y + q / y, r);
        found[i] = (discriminant > 0.0 ? -2.0 * cosine : alone) - third;
        found[BLOCK + i] = (discriminant > 0.0 ? cosine - sine : -HUGE) - third;
        found[2 * BLOCK + i] = (discriminant > 0.0 ? cosine + sine : -HUGE) - third;
    }
    for (int k = 0; k < 3; k++)
        for (size_t i = 0; i < n; i++) {
            double c0 = c[i], c1 = c[BLOCK + i], c2 = c[2 * BLOCK + i], c3 = c[3 * BLOCK + i];
            double t = found[k * BLOCK + i];
            found[k * BLOCK + i] = t - (((c3 * t + c2) * t + c1) * t + c0) / ((3.0 * c3 * t + 2.0 * c2) * t + c1);
        }
}

/* Distances (n) of the nearest images of points (n, 3) in cameras with vertices and rays (n, 3, 3), all looked for, HUGE
 * where there are none: project, without certainty. */
void images(size_t n, const double *vertices, const double *rays, const double *points, double *out) {
    static double still[9 * BLOCK], moving[9 * BLOCK], c[4 * BLOCK], found[3 * BLOCK];
    for (size_t start = 0; start < n; start += BLOCK) {
        size_t some = n - start < BLOCK ? n - start : BLOCK;
        for (size_t i = 0; i < some; i++)
            for (int k = 0; k < 9; k++) {
                size_t own = 9 * (start + i) + k, first = 9 * (start + i) + k % 3;
                still[k * BLOCK + i] = vertices[own] - (k < 3 ? points[3 * (start + i) + k] : vertices[first]);
                moving[k * BLOCK + i] = rays[own] - (k < 3 ? 0.0 : rays[first]);
            }
        spread(some, BLOCK, still, moving, c);
        roots(some, c, found);
        for (int k = 0; k < 3; k++)
            for (size_t i = 0; i < some; i++) {
                double s = found[k * BLOCK + i];
                vec place = add(at(still, BLOCK, i), times(s, at(moving, BLOCK, i)));
                vec one = add(at(still + 3 * BLOCK, BLOCK, i), times(s, at(moving + 3 * BLOCK, BLOCK, i)));
                vec two = add(at(still + 6 * BLOCK, BLOCK, i), times(s, at(moving + 6 * BLOCK, BLOCK, i)));
                vec normal = cross(one, two);
                double second = dot(cross(two, place), normal), third = dot(cross(place, one), normal);
                double least = fmin(fmin(second, third), dot(normal, normal) - second - third);
                double before = k ? out[start + i] : HUGE;
                out[start + i] = s > 0.0 && least >= 0.0 && s < before ? s : before;
            }
    }
}

/* (u, v) and s of n points (3, n) after steps of Newton's method on triangles `member` of k with `shape` (18, k), and
 * how long the last one was, for a perspective eye: walk's Newton. `longest` is how far a step goes at most. */
void newton(size_t n, size_t k, int steps, double longest, const double *restrict shape,
            const long long *restrict member, double *restrict uvs, const double *restrict points,
            double *restrict moved) {
    for (size_t start = 0; start < n; start += BLOCK) {
        size_t end = start + BLOCK < n ? start + BLOCK : n;
        for (int step = 0; step < steps; step++)
            for (size_t i = start; i < end; i++) {
                const double *own = shape + member[i];
                vec along_u = at(own + 3 * k, k, 0), along_v = at(own + 6 * k, k, 0);
                vec turn_u = at(own + 12 * k, k, 0), turn_v = at(own + 15 * k, k, 0);
                double u = uvs[i], v = uvs[n + i], s = uvs[2 * n + i];
                vec place = add(at(own, k, 0), add(times(u, along_u), times(v, along_v)));
                vec normal = add(at(own + 9 * k, k, 0), add(times(u, turn_u), times(v, turn_v)));
                double inverse = 1.0 / dot(normal, normal), slope = 2.0 * dot(place, normal) * inverse;
                double by_u = dot(along_u, normal) + dot(place, turn_u) - slope * dot(normal, turn_u);
                double by_v = dot(along_v, normal) + dot(place, turn_v) - slope * dot(normal, turn_v);
                vec ray = sub(place, times(slope, normal));
                vec c0 = sub(sub(along_u, times(2.0 * by_u * inverse, normal)), times(slope, turn_u));
                vec c1 = sub(sub(along_v, times(2.0 * by_v * inverse, normal)), times(slope, turn_v));
                c0 = add(along_u, times(s, c0));
                c1 = add(along_v, times(s, c1));
                vec right = sub(sub(at(points, n, i), place), times(s, ray));
                vec across = cross(c1, ray), turned = cross(right, c0);
                double determinant = dot(c0, across), per = 1.0 / (fabs(determinant) > TINY ? determinant : TINY);
                double du = dot(right, across) * per, dv = -dot(turned, ray) * per;
                double length = fmax(fabs(du), fabs(dv)), share = 1.0 / fmax(1.0, length / longest);
                uvs[i] = u + share * du;
                uvs[n + i] = v + share * dv;
                uvs[2 * n + i] = s + share * dot(turned, c1) * per;
                moved[i] = length;
            }
    }
}
