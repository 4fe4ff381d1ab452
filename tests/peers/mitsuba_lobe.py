"""The reflection of the scene format as a BSDF of Mitsuba, none of whose own has Schlick's Fresnel with that G, or a Phong lobe.

Written from the formulas, sharing no code with ours; Mitsuba's own microfacet distribution gives GGX's D and its visible normals.
"""

from __future__ import annotations

from typing import Any

import numpy as np


def register(mi: Any) -> None:
    """The plugin "scene_format_lobe": albedo (a texture), specular_r, _g, _b, lobe, alpha (of GGX) and exponent (of the others)."""
    import drjit as dr

    class Lobe(mi.BSDF):  # type: ignore[misc, name-defined]
        def __init__(self, props: Any) -> None:
            mi.BSDF.__init__(self, props)
            self.albedo, self.kind = props["albedo"], str(props["lobe"])
            self.alpha, self.n = float(props["alpha"]), float(props["exponent"])
            self.specular = mi.Color3f(*(float(props[f"specular_{c}"]) for c in "rgb"))
            self.share = 0.5  # of the glossy lobe among the directions sampled
            diffuse = mi.BSDFFlags.DiffuseReflection | mi.BSDFFlags.FrontSide | mi.BSDFFlags.SpatiallyVarying
            self.m_components = [diffuse, mi.BSDFFlags.GlossyReflection | mi.BSDFFlags.FrontSide]
            self.m_flags = self.m_components[0] | self.m_components[1]

        def microfacets(self) -> Any:
            return mi.MicrofacetDistribution(mi.MicrofacetType.GGX, self.alpha, True)

        def mirrored(self, w: Any) -> Any:
            return mi.Vector3f(-w.x, -w.y, w.z)

        def smith(self, cosine: Any) -> Any:
            """Lambda of Smith's shadowing for GGX."""
            tan2 = dr.maximum(1 - cosine * cosine, 0) / (cosine * cosine)
            return 0.5 * (dr.sqrt(1 + self.alpha * self.alpha * tan2) - 1)

        def lobe(self, wi: Any, wo: Any) -> tuple[Any, Any]:
            """Value without the cosine, and density of `lobe_sample`."""
            h, n = dr.normalize(wi + wo), self.n
            if self.kind == "ggx":
                m, (ci, co) = self.microfacets(), (mi.Frame3f.cos_theta(w) for w in (wi, wo))
                fresnel = self.specular + (1 - self.specular) * (1 - dr.clip(dr.dot(wi, h), 0, 1)) ** 5
                value = fresnel * (m.eval(h) / (4 * ci * co * (1 + self.smith(ci) + self.smith(co))))
                return value, m.pdf(wi, h) / (4 * dr.dot(wo, h))
            if self.kind == "phong":
                power = dr.power(dr.maximum(dr.dot(self.mirrored(wi), wo), 0), n)
                return self.specular * ((n + 2) / (2 * np.pi) * power), (n + 1) / (2 * np.pi) * power
            power = dr.power(dr.maximum(h.z, 0), n)
            scale = (n + 2) * (n + 4) / (8 * np.pi * (2 ** (-n / 2) + n))
            return self.specular * (scale * power), (n + 1) / (2 * np.pi) * power / (4 * dr.abs(dr.dot(wo, h)))

        def lobe_sample(self, wi: Any, u: Any) -> Any:
            if self.kind == "ggx":
                return mi.reflect(wi, self.microfacets().sample(wi, u)[0])
            cosine = dr.power(1 - u.x, 1 / (self.n + 1))
            sine, phi = dr.sqrt(dr.maximum(1 - cosine * cosine, 0)), 2 * np.pi * u.y
            about = mi.Vector3f(sine * dr.cos(phi), sine * dr.sin(phi), cosine)
            return mi.Frame3f(self.mirrored(wi)).to_world(about) if self.kind == "phong" else mi.reflect(wi, about)

        def eval_pdf(self, ctx: Any, si: Any, wo: Any, active: Any = True) -> tuple[Any, Any]:
            ci, co = mi.Frame3f.cos_theta(si.wi), mi.Frame3f.cos_theta(wo)
            active = active & (ci > 0) & (co > 0)
            value, density = self.lobe(si.wi, wo)
            reflected = (self.albedo.eval(si, active) / np.pi + value) * co
            pdf = (1 - self.share) * co / np.pi + self.share * density
            return dr.select(active, reflected, 0), dr.select(active, pdf, 0)

        def eval(self, ctx: Any, si: Any, wo: Any, active: Any = True) -> Any:
            return self.eval_pdf(ctx, si, wo, active)[0]

        def pdf(self, ctx: Any, si: Any, wo: Any, active: Any = True) -> Any:
            return self.eval_pdf(ctx, si, wo, active)[1]

        def sample(self, ctx: Any, si: Any, choose: Any, u: Any, active: Any = True) -> tuple[Any, Any]:
            glossy = choose < self.share
            sample = mi.BSDFSample3f()
            sample.wo = dr.select(glossy, self.lobe_sample(si.wi, u), mi.warp.square_to_cosine_hemisphere(u))
            value, sample.pdf = self.eval_pdf(ctx, si, sample.wo, active)
            sample.eta = 1.0
            sample.sampled_component = dr.select(glossy, mi.UInt32(1), mi.UInt32(0))
            sample.sampled_type = dr.select(glossy, mi.UInt32(+mi.BSDFFlags.GlossyReflection), mi.UInt32(+mi.BSDFFlags.DiffuseReflection))
            return sample, dr.select(active & (sample.pdf > 0), value / sample.pdf, 0)

        def to_string(self) -> str:
            return f"Lobe[{self.kind}]"

    mi.register_bsdf("scene_format_lobe", Lobe)
