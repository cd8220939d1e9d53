# SPDX-License-Identifier: BSD-3-Clause
"""Every filter, writer and representation of ParaView gives on a series what it gives on plain arrays.

    python3 crawl_filters.py --plugin Banyan.so --out FOLDER [--ranks N] [--only NAME...]

Starts pvbatch with all proxies of the groups "filters" and "writers", each with its defaults, on a
reader that defers decoding and on one that does not, and compares values at several times. Where a
proxy kills pvbatch or takes too long it is named, and the rest goes on in a new process. Takes
minutes; `ctest` runs a choice (test_filters.py).
"""
import argparse
import filecmp
import glob
import os
import queue
import re
import shutil
import signal
import subprocess
import sys
import threading

SECONDS_PER_PROXY = 100
NOTHING = 1 << 30
TIMES = (0.0, 1.25, 2.0)
# They wait for others, look for files, or give something else each time.
LEFT_OUT = re.compile("|".join((
    "Catalyst", "LiveSource", "ProgrammableAnnotation", "RandomAttributes", "RandomVectors",
    "AddFieldArrays", "EnvironmentAnnotation")))
# What is different although no value is: reasons by the names of proxies.
KNOWN = {
    "BanyanTemporalEnhancement": "takes its scale from the series, where there is one",
    "BrownianPoints|RandomAttribute.*": "random numbers",
    "ExtractHistogram2D|ExtractBlock|InSituParticlePath|ValidateCells|XML(Hier|Multi|PVAni|Uniform).*|"
    "XMLPartitionedDataSetColl.*": "fails on plain arrays, too",
    "(XML|JSON|DataSet|Xdmf).*Writer": "writes ranges that ParaView asked for, times, or its path",
}
# Lines and pieces that come in another order each time.
UNORDERED = re.compile("StreamTracer|StreakLine|Particle|PathLines")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--plugin", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--only", nargs="*", help="names of proxies")
    parser.add_argument("--worker", type=int, help="number of the proxy to begin with")
    return parser.parse_args()


# ------------------------------------------------------------------------------------ the worker


def worker(options):
    # pylint: disable=import-outside-toplevel
    from paraview import servermanager, simple

    import compare_data
    import pictures
    import session
    import test_filters

    def fields(step):
        """Arrays of several types, each with values on both sides of its middle."""
        p, v = test_filters.fields(step)
        return {"p": p, "v": v, "d": p.astype("f8") ** 2, "n": (p * 100).astype("i4"),
                "b": (p * 250).astype("u1"), "l": (p * 1000).astype("i8"),
                "w": (v * 30).astype("i2")}

    def inputs_of(proxy):
        found = []
        iterator = proxy.NewPropertyIterator()
        while not iterator.IsAtEnd():
            if iterator.GetProperty().IsA("vtkSMInputProperty"):
                found.append(iterator.GetKey())
            iterator.Next()
        return found

    def connect(proxy, source):
        for name in inputs_of(proxy):
            values = proxy.GetProperty(name)
            values.RemoveAllProxies()
            values.AddInputConnection(source.SMProxy, 0)

    def make(group, name, source, like=None):
        """The proxy on a source, with its defaults or with all properties of another."""
        manager = servermanager.ProxyManager()
        controller = servermanager.ParaViewPipelineController()
        proxy = manager.NewProxy(group, name)
        if proxy is None:
            return None
        controller.PreInitializeProxy(proxy)
        connect(proxy, source)
        controller.PostInitializeProxy(proxy)
        if like is not None:
            proxy.Copy(like, "vtkSMInputProperty")
        proxy.UpdateVTKObjects()
        return proxy

    def outputs(proxy):
        algorithm = proxy.GetClientSideObject()
        if algorithm is None:
            return []
        return [algorithm.GetOutputDataObject(i)
                for i in range(algorithm.GetNumberOfOutputPorts())]

    def compare_filter(group, name, path):
        deferred, plain = test_filters.readers(path)
        # Defaults of filters depend on what the data have; some keep pointers to arrays of then.
        plain.UpdatePipeline(TIMES[0])
        deferred.UpdatePipeline(TIMES[0])
        theirs = make(group, name, plain)
        if theirs is None or not theirs.IsA("vtkSMSourceProxy") or not inputs_of(theirs):
            return None
        ours = make(group, name, deferred, theirs)
        compare = compare_data.compare_unordered if UNORDERED.search(name) else compare_data.compare
        wrong, size = [], 0
        for time in TIMES:
            theirs.UpdatePipeline(time)
            ours.UpdatePipeline(time)
            for a, b in zip(outputs(ours), outputs(theirs)):
                if b is None:
                    continue
                size += compare_data.size(b)
                wrong += [f"at {time}: {text}" for text in compare(a, b)]
        return wrong, size

    def compare_writer(group, name, path):
        sizes = []
        for kind, source in zip(("deferred", "plain"), test_filters.readers(path)):
            folder = os.path.join(options.out, "written", kind, name)
            shutil.rmtree(folder, ignore_errors=True)
            os.makedirs(folder)
            source.UpdatePipeline(1.0)
            proxy = make(group, name, source)
            if proxy is None or not proxy.GetProperty("FileName"):
                return None
            proxy.GetProperty("FileName").SetElement(0, os.path.join(folder, "file.out"))
            proxy.UpdateVTKObjects()
            proxy.UpdatePipeline(1.0)
            sizes.append(sum(map(os.path.getsize, glob.glob(folder + "/**/*.*", recursive=True))))
        folders = [os.path.join(options.out, "written", kind, name)
                   for kind in ("deferred", "plain")]
        same = filecmp.dircmp(*folders)
        wrong = [f"{file} differs" for file in same.diff_files + same.left_only + same.right_only]
        return wrong, sizes[1]

    def compare_display(group, name, path):
        """Pictures of a way to show the data."""
        shots = []
        for kind, source in zip(("deferred", "plain"), test_filters.readers(path)):
            view = session.new_view((160, 120))
            display = simple.Show(source, view)
            display.SetRepresentationType(name)
            simple.ColorBy(display, ("POINTS", "p"))
            functions = simple.GetColorTransferFunction("p"), simple.GetOpacityTransferFunction("p")
            for function in functions:
                function.RescaleTransferFunction(0.0, 1.0)
            for time in TIMES:
                view.ViewTime = time
                file = os.path.join(options.out, f"{kind}.png")
                simple.SaveScreenshot(file, view)
                shots.append(pictures.load(file))
            session.clear()
        count = len(TIMES)
        wrong = [f"at {time}: pictures differ by {pictures.difference(a, b).max()}"
                 for time, a, b in zip(TIMES, shots[:count], shots[count:])
                 if pictures.difference(a, b).max() > 1]
        return wrong, shots[0].size

    session.begin(options)
    path = os.path.join(options.out, "series.banyan")
    if not os.path.exists(path):
        test_filters.make_series(options.out, fields)
    names = []
    for group in ("filters", "writers"):
        definitions = servermanager.ProxyManager().GetProxyDefinitionManager()
        iterator = definitions.NewSingleGroupIterator(group)
        iterator.InitTraversal()
        while not iterator.IsDoneWithTraversal():
            names.append((group, iterator.GetProxyName()))
            iterator.GoToNextItem()
    names.sort()
    shown = simple.Show(test_filters.readers(path)[0], session.new_view((160, 120)))
    names += [("displays", name) for name in shown.GetProperty("Representation").Available]
    session.clear()
    simple._DisableFirstRenderCameraReset()
    for number, (group, name) in enumerate(names):
        if (number < options.worker or LEFT_OUT.search(name)
                or options.only and name not in options.only):
            continue
        print(f"\n@begin {number} {group} {name}", flush=True)
        compare = {"filters": compare_filter, "writers": compare_writer,
                   "displays": compare_display}[group]
        try:
            result = compare(group, name, path)
        except Exception as error:  # pylint: disable=broad-except
            result = [f"raised {error!r}"], 0
        if result is None:
            print(f"\n@end {number} skipped", flush=True)
        else:
            print(f"\n@end {number} {result[1]} {'; '.join(result[0]) or 'equal'}", flush=True)
    print("\n@done", flush=True)


# ------------------------------------------------------------------------------------ the driver


def run_worker(options, first, log, ranks):
    """Goes through the proxies from `first`. The last one begun, and whether all were done."""
    # Symmetric scripts would get no defaults: without --sym the first rank compares its piece.
    command = ["pvbatch", os.path.abspath(__file__), "--plugin", options.plugin,
               "--out", options.out, "--worker", str(first)]
    if ranks > 1:
        command = ["mpiexec", "--oversubscribe", "-n", str(ranks), *command]
    if options.only:
        command += ["--only", *options.only]
    begun, done, ended = first, False, {}
    current = None
    # VTK's messages would come in the middle of our lines.
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=log, text=True, errors="replace",
                          start_new_session=True) as process:
        lines = queue.Queue()
        threading.Thread(target=lambda: [lines.put(line) for line in process.stdout] +
                         [lines.put(None)], daemon=True).start()
        while True:
            try:
                line = lines.get(timeout=SECONDS_PER_PROXY)
            except queue.Empty:
                os.killpg(process.pid, signal.SIGKILL)
                ended.setdefault(begun, []).append("takes too long")
                break
            if line is None:
                break
            log.write(line)
            if line.startswith("@begin"):
                _, number, _, current = line.strip().split(maxsplit=3)
                begun = int(number)
                ended.setdefault("names", {})[begun] = current
            elif line.startswith("@end"):
                _, number, rest = line.split(maxsplit=2)
                ended.setdefault(int(number), []).append(rest.strip())
            elif line.startswith("@done"):
                done = True
    return begun, done, ended


def main():
    options = arguments()
    if options.worker is not None:
        worker(options)
        return
    os.makedirs(options.out, exist_ok=True)
    first, results, names = 0, {}, {}
    with open(os.path.join(options.out, "crawl.log"), "w", encoding="utf8") as log:
        # The series is made by one rank, before there is anything to compare.
        run_worker(options, NOTHING, log, 1)
        while True:
            begun, done, ended = run_worker(options, first, log, options.ranks)
            names.update(ended.pop("names", {}))
            for number, texts in ended.items():
                results.setdefault(number, []).extend(texts)
            if done or not ended and begun not in names:
                break
            if begun in names and begun not in results:
                results.setdefault(begun, []).append("kills or stops pvbatch")
            first = begun + 1
    different = 0
    for number in sorted(names):
        for text in sorted(set(results.get(number, ["no answer"]))):
            if not text.endswith("equal") and text != "skipped":
                why = [reason for name, reason in KNOWN.items() if re.fullmatch(name, names[number])]
                different += not why
                print(f"{names[number]}: {text[:400]}{''.join(f' ({reason})' for reason in why)}")
    compared = sum(any(t.split()[0] not in ("0", "skipped") for t in results.get(n, []))
                   for n in names)
    print(f"{len(names)} proxies, {compared} gave something to compare, {different} differ")
    sys.exit(different > 0)


if __name__ == "__main__":
    main()
