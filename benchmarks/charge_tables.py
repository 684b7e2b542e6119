#!/usr/bin/env python3
"""Prints the tables of docs/about/measurements.md, section Charge, from the JSON of benchmarks/charge.

usage: charge_tables.py BENCH.json
"""
import json
import math
import sys


def row_of(rows, **wanted):
    """The row with these members; None: there is none."""
    found = [row for row in rows if all(row.get(key) == value for key, value in wanted.items())]
    return found[0] if found else None


def kinds_of(rows, key):
    return list(dict.fromkeys(row[key] for row in rows))


def brief(value, digits=2):
    """Two digits and an exponent, as 4.4e-4; a dash for what is not known."""
    if value is None:
        return "-"
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    return f"{mantissa}e{int(exponent)}"


def plain(value):
    """Three digits, or all of a larger number."""
    return f"{value:,.0f}" if value >= 100 else f"{value:.3g}"


def print_row(*cells):
    print("| " + " | ".join(str(cell) for cell in cells) + " |")


def print_head(*cells):
    print()
    print_row(*cells)
    print_row(*["---"] * len(cells))


def order_of(before, now, key):
    if before is None or now[key] is None:
        return "-"
    return f"{2 * math.log(before[key] / now[key]) / math.log(now['triangles'] / before['triangles']):.1f}"


def print_errors(rows):
    print_head("body", "triangles", "capacitance", "its error", "order", "densities, rms", "order", "largest", "iterations", "s", "MiB",
               "coarse: error", "rms", "largest", "iterations", "s")
    for body in kinds_of(rows, "body"):
        before = None
        for triangles in kinds_of([row for row in rows if row["body"] == body], "triangles"):
            tree = row_of(rows, body=body, triangles=triangles, solver="tree")
            coarse = row_of(rows, body=body, triangles=triangles, solver="coarse")
            print_row(body, f"{triangles:,}", f"{tree['capacitance']:.6f}", brief(tree["capacitance_error"]),
                      order_of(before, tree, "capacitance_error"), brief(tree["density_rms"]), order_of(before, tree, "density_rms"),
                      brief(tree["density_largest"]), tree["iterations"], plain(tree["total_ms"] / 1e3),
                      plain(tree["peak_bytes"] / 2**20), brief(coarse["capacitance_error"]), brief(coarse["density_rms"]),
                      brief(coarse["density_largest"]), coarse["iterations"], plain(coarse["total_ms"] / 1e3))
            before = tree


def print_ranks(rows):
    print_head("body", "triangles", "solver", "Spearman", "lowest tenth", "capacitance", "densities, rms", "largest", "iterations")
    for row in rows:
        print_row(row["body"], f"{row['triangles']:,}", row["solver"], f"{row['correlation']:.6f}", f"{row['overlap']:.3f}",
                  brief(row["capacitance_difference"]), brief(row["density_rms"]), brief(row["density_largest"]), row["iterations"])


def print_times(rows):
    print_head("triangles", "solver", "assembly", "solve", "charge", "regions", "all", "MiB", "iterations", "two threads: charge", "all")
    for row in rows:
        if row["threads"] != 1:
            continue
        two = row_of(rows, triangles=row["triangles"], solver=row["solver"], threads=2)
        cells = [plain(row[key] / 1e3) for key in ("assembly_ms", "solve_ms", "charge_ms", "regions_ms", "total_ms")]
        print_row(f"{row['triangles']:,}", row["solver"], *cells, plain(row["peak_bytes"] / 2**20), row["iterations"] or "-",
                  *[plain(two[key] / 1e3) if two else "-" for key in ("charge_ms", "total_ms")])


def hard_cell(row):
    if row is None:
        return "-"
    if row["status"] != "ok":
        return "refused"
    cells = [brief(abs(row["capacitance"] / row["exact"] - 1))] if row["exact"] is not None else ["solved"]
    if row["solver"] != "dense":
        cells.append(str(row["iterations"]))
    return "; ".join(cells)


def print_hard(rows):
    print_head("mesh", "triangles", "components", "dense", "tree; iterations", "coarse; iterations", "tree beside dense", "s: dense", "tree", "coarse")
    for body in kinds_of(rows, "body"):
        by = {solver: row_of(rows, body=body, solver=solver) for solver in ("dense", "tree", "coarse")}
        tree, dense = by["tree"], by["dense"]
        both = dense is not None and dense["capacitance"] is not None and tree["capacitance"] is not None
        print_row(body, f"{tree['triangles']:,}", f"{tree['components']:,}", *[hard_cell(row) for row in by.values()],
                  brief(abs(tree["capacitance"] / dense["capacitance"] - 1)) if both else "-",
                  *[plain(row["total_ms"] / 1e3) if row else "-" for row in by.values()])


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with open(sys.argv[1], encoding="utf-8") as file:
        rows = json.load(file)["rows"]
    for table, printer in {"errors": print_errors, "ranks": print_ranks, "times": print_times, "hard": print_hard}.items():
        chosen = [row for row in rows if row["table"] == table]
        if chosen:
            printer(chosen)


if __name__ == "__main__":
    main()
