"""Results as Markdown: one table a shape, the best setting of each method."""

_DENOISED = ["RMSE", "surface", "curves", "near edges", "surface covered", "curves", "border",
             "edges", "CPU s", "MB"]
_RESAMPLED = ["RMSE", "curves", "max", "surface covered", "curves", "edges", "points", "variation",
              "CPU s", "MB"]


def best_of(runs):
    """The run with the least error; of failed ones the first."""
    good = [run for run in runs if run["outcome"] == "ok"]
    return min(good, key=lambda run: run["error"]["rmse"]) if good else runs[0]


def settings_text(settings):
    return ", ".join(f"{name} {value}" for name, value in settings.items()) or "none"


def _length(value):
    return "" if value is None else f"{value:.4f}"


def _denoised_cells(error):
    parts, covered = error["parts"], error["coverage"]
    rmse = {name: parts.get(name, {}).get("rmse") for name in ("surface", "curve", "nearEdges")}
    return [_length(value) for value in
            (error["rmse"], rmse["surface"], rmse["curve"], rmse["nearEdges"],
             covered.get("surface"), covered.get("curve"), covered.get("border"),
             covered.get("edge"))]


def _resampled_cells(error):
    covered = error["coverage"]
    lengths = [error["rmse"], error["parts"].get("curve", {}).get("rmse"), error["max"],
               covered.get("surface"), covered.get("curve"), covered.get("edge")]
    return [*map(_length, lengths), str(error["points"]), f"{error['spacing']['variation']:.2f}"]


def _row(label, run, cells_of, columns):
    if run["outcome"] != "ok":
        cells = [run["outcome"]] + [""] * (len(columns) - 3)
    else:
        cells = cells_of(run["error"])
    cost = [f"{run['cpuSeconds']:.1f}", f"{run['memoryBytes'] / 1e6:.0f}"]
    return [label, *cells, *cost, settings_text(run["settings"])]


def _table(input_error, named_runs, cells_of, columns):
    head = ["method", *columns, "settings"]
    rows = [head, ["---"] * len(head)]
    if input_error:
        rows.append(["input", *cells_of(input_error), "", "", ""])
    rows += [_row(label, best_of(runs), cells_of, columns) for label, runs in named_runs]
    return ["| " + " | ".join(row) + " |" for row in rows]


def shape_section(shape, facts, denoised, resampled):
    """Lines of Markdown for one shape.

    @param facts     what is told of the scan: noise, points, error
    @param denoised  list of (label, runs); resampled likewise
    """
    lines = [f"### {shape.name}", "",
             f"{facts['points']} points, noise {facts['noise']:.4g}, "
             f"diagonal {facts['error']['diagonal']:.4g}.", ""]
    if denoised:
        lines += _table(facts["error"], denoised, _denoised_cells, _DENOISED) + [""]
    if resampled:
        lines += [f"Resampled to {shape.resample} points:", ""]
        lines += _table(None, resampled, _resampled_cells, _RESAMPLED) + [""]
    return lines


def tried_section(named_runs):
    """Lines that tell every run, the best or not."""
    lines = ["| shape | method | settings | RMSE | CPU s | outcome |", "|---|---|---|---|---|---|"]
    for label, run in named_runs:
        error = _length(run["error"]["rmse"]) if run["outcome"] == "ok" else ""
        lines.append(f"| {run['shape']} | {label} | {settings_text(run['settings'])} | {error} | "
                     f"{run['cpuSeconds']:.1f} | {run['outcome']} |")
    return lines
