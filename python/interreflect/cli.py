"""The command line. Heavy imports stay inside the commands, so that help comes at once; a user's error is one line and exit code 2."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Annotated, Any

import typer

app = typer.Typer(
    name="interreflect",
    help="A laboratory for real-time global illumination: methods against truth, speed against accuracy.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
cache_app = typer.Typer(help="What is kept on disk: scenes, references, precomputations.", no_args_is_help=True)
app.add_typer(cache_app, name="cache")

USER_ERRORS = (ValueError, TypeError, OSError, ImportError)  # what wrong input raises; all else is a fault of ours and shows its traceback


def main() -> None:
    """The entry point: runs a command; what a user did wrong is said in one line on standard error, with exit code 2."""
    try:
        app()
    except KeyboardInterrupt:
        print("interreflect: interrupted; a study goes on where it stopped when it is run again", file=sys.stderr)
        sys.exit(130)
    except USER_ERRORS as error:
        print(f"interreflect: {type(error).__name__}: {' '.join(str(error).split())}", file=sys.stderr)
        sys.exit(2)


@app.command()
def scenes() -> None:
    """List the built-in scenes with their knobs."""
    from interreflect.catalogue import scene_rows

    _print_table("scene", scene_rows())


@app.command()
def methods() -> None:
    """List the methods with their stages and knobs."""
    from interreflect.catalogue import method_rows

    _print_table("method", method_rows())


@app.command()
def techniques(stage: Annotated[str | None, typer.Argument(help="one stage only")] = None) -> None:
    """List the techniques of every stage with their knobs."""
    from interreflect.catalogue import technique_rows

    _print_table("technique", technique_rows(stage))


@app.command()
def render(
    scene: Annotated[str, typer.Argument(help="a scene file, or the name of a built-in scene")],
    method: Annotated[str, typer.Option(help="a method's name, as `interreflect methods` lists them")] = "voxel-cone-tracing",
    preset: Annotated[str | None, typer.Option(help="a paper's configuration of the method, by name; --set changes it")] = None,
    set_: Annotated[list[str] | None, typer.Option("--set", help="a knob: path=value, e.g. grid.resolution=64; repeatable")] = None,
    camera: Annotated[str | None, typer.Option(help="a camera's name; the scene's first if absent")] = None,
    size: Annotated[str, typer.Option(help="width x height in pixels")] = "640x360",
    seed: Annotated[int, typer.Option(help="seed of the random numbers")] = 0,
    threads: Annotated[int | None, typer.Option(help="threads; all if absent")] = None,
    output: Annotated[Path, typer.Option("-o", "--output", help="an image file; .exr and .hdr keep linear light")] = Path("frame.exr"),
) -> None:
    """Render one picture and say where the time went."""
    from interreflect.catalogue import find_scene, parse_size

    world = find_scene(scene)
    chosen = _method(method, preset, set_)
    for warning in world.warnings:
        print(f"warning: {warning}", file=sys.stderr)
    frame = chosen.render(world, camera=camera, size=parse_size(size), seed=seed, threads=threads)
    frame.save(output)
    print(frame.profile)
    print(f"wrote {output}")


@app.command()
def view(
    scene: Annotated[str, typer.Argument(help="a scene file, or the name of a built-in scene")],
    method: Annotated[str, typer.Option(help="the method to begin with, as `interreflect methods` lists them")] = "voxel-cone-tracing",
    preset: Annotated[str | None, typer.Option(help="a paper's configuration of the method, by name; --set changes it")] = None,
    set_: Annotated[list[str] | None, typer.Option("--set", help="a knob: path=value, e.g. grid.resolution=64; repeatable")] = None,
    camera: Annotated[str | None, typer.Option(help="a camera's name; the scene's first if absent")] = None,
    lines: Annotated[int, typer.Option(help="height of the picture in pixels")] = 270,
    host: Annotated[str, typer.Option(help="the address to listen on; only this machine reaches the default")] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="the port to listen on, or the next free one")] = 8080,
    threads: Annotated[int | None, typer.Option(help="threads; all if absent")] = None,
) -> None:
    """Open a page in which to fly through a scene, turn knobs and compare with the truth, until Ctrl-C."""
    from interreflect.catalogue import find_scene, scene_code
    from interreflect.live.server import view as open_view

    world = find_scene(scene)
    for warning in world.warnings:
        print(f"warning: {warning}", file=sys.stderr)
    chosen = _method(method, preset, set_)
    with open_view(
        world, chosen, camera, lines=lines, host=host, port=port, threads=threads, scene_code=scene_code(scene)
    ) as page, suppress(KeyboardInterrupt):  # fmt: skip
        print(f"{page.address}  (Ctrl-C ends it)", flush=True)
        page.wait()


def _method(name: str, preset: str | None, settings: list[str] | None) -> Any:
    """A method by name, as a preset has it, with what `--set` changes."""
    from interreflect.catalogue import find_method, parse_knobs

    plain = find_method(name)
    return (plain if preset is None else type(plain).preset(preset)).replace(parse_knobs(settings or []))


@app.command()
def study(
    file: Annotated[Path, typer.Argument(help="a Python file that defines `study`")],
    out: Annotated[Path, typer.Option(help="the folder of the records; a study that stopped goes on there")],
    timeout: Annotated[float | None, typer.Option(help="seconds that a cell may take, its truth apart")] = None,
    memory: Annotated[float | None, typer.Option(help="MiB that a cell may hold")] = None,
    dask: Annotated[str | None, typer.Option(help="a Dask scheduler whose hosts measure the cells, e.g. tcp://10.0.0.1:8786")] = None,
) -> None:
    """Measure a study: every cell that its folder does not hold yet."""
    from interreflect.catalogue import load_study
    from interreflect.charts import label
    from interreflect.study.pareto import pareto
    from interreflect.study.records import OK
    from interreflect.study.run import run

    wanted = load_study(file)
    with _cluster(dask) as client:
        records = run(wanted, out, timeout=timeout, memory=None if memory is None else memory * 2**20, client=client)
    failed = [record for record in records if record.status != OK]
    front = pareto(records)
    columns = ["scene", "camera", "bounces", "milliseconds", "relmse", "note"]
    rows = [[label(records, row), *(_text(row[name]) for name in columns)] for _, row in front.iterrows()]
    _print_rows("on the front", ["configuration", *columns], rows)
    for record in failed:
        print(f"{record.status}: {record.scene}, {record.configuration}, seed {record.seed}: {record.failure}", file=sys.stderr)
    print(f"{len(records)} cells in {out}, {len(failed)} failed")


@contextmanager
def _cluster(address: str | None) -> Iterator[Any]:
    """A client of the scheduler there; None without an address. ImportError without the extra, OSError where nobody answers."""
    if address is None:
        yield None
        return
    from interreflect.study.dask import connect

    with connect(address) as client:
        yield client


@app.command()
def report(
    folder: Annotated[Path, typer.Argument(help="the folder of a study's records")],
    output: Annotated[Path, typer.Option("-o", "--output", help="the HTML file to write")] = Path("report.html"),
) -> None:
    """Write one self-contained page from a study's records."""
    from interreflect.study.report import report as write_report
    from interreflect.study.store import load_records

    print(f"wrote {write_report(load_records(folder), output)}")


@cache_app.command("list")
def cache_list() -> None:
    """List what the cache holds."""
    import interreflect.cache as cache

    entries = cache.entries()
    rows = [[entry.kind, entry.path.name, f"{entry.bytes / 2**20:.1f}"] for entry in entries]
    _print_rows(f"cache in {cache.folder()}", ["kind", "file", "MiB"], rows)
    files, size = sum(entry.files for entry in entries), sum(entry.bytes for entry in entries)
    print(f"{files} files, {size / 2**20:.1f} of at most {cache.MAX_BYTES / 2**20:.0f} MiB")


@cache_app.command("clear")
def cache_clear() -> None:
    """Remove everything from the cache."""
    import interreflect.cache as cache

    print(f"removed {cache.clear()} files from {cache.folder()}")


def _print_table(what: str, rows: list[tuple[str, ...]]) -> None:
    _print_rows("", [what, "knob", "type", "unit", "range", "default", "meaning"], [list(row) for row in rows])


def _print_rows(title: str, columns: list[str], rows: list[list[str]]) -> None:
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table(title=title or None, title_justify="left")
    for name in columns:
        table.add_column(name, overflow="fold")
    for row in rows:
        table.add_row(*(Text(cell) for cell in row))
    console = Console()
    if not console.is_terminal:
        console.width = 200  # pipes and files have no width of their own
    console.print(table)


def _text(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)
